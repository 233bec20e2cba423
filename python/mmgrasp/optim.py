"""Optimisation: set covers, tours, assignments and shared stops with proof; search by values without
derivatives; nonlinear problems of one's own; weights of objectives."""

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
    NonlinearProblem as NonlinearProblem,
    NlpResult as NlpResult,
    solve_nonlinear as solve_nonlinear,
    pairwise_weights as pairwise_weights,
    PairwiseWeights as PairwiseWeights,
)
