"""Discrete optimisation with proof: set covers, visiting tours, assignments, and stops shared among robots."""

from ._core import (
    solve_set_cover as solve_set_cover,
    SetCoverResult as SetCoverResult,
    shortest_visiting_tour as shortest_visiting_tour,
    TourResult as TourResult,
    cheapest_assignment as cheapest_assignment,
    share_stops as share_stops,
    SharedTours as SharedTours,
)
