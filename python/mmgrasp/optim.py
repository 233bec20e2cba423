"""Optimisation: set covers, tours, assignments and shared stops with proof; search by values without derivatives; weights of objectives."""

from ._core import (
    solve_set_cover as solve_set_cover,
    SetCoverResult as SetCoverResult,
    shortest_visiting_tour as shortest_visiting_tour,
    TourResult as TourResult,
    cheapest_assignment as cheapest_assignment,
    share_stops as share_stops,
    SharedTours as SharedTours,
    minimize_derivative_free as minimize_derivative_free,
    derivative_free_solver_names as derivative_free_solver_names,
    DerivativeFreeResult as DerivativeFreeResult,
    pairwise_weights as pairwise_weights,
    PairwiseWeights as PairwiseWeights,
)
