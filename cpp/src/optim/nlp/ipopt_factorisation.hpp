#pragma once

namespace mmgrasp::detail {

/// Gives SparseLdlt to Ipopt in the place of HSL_MA97, which Ipopt calls through pointers to functions (HSLLoader.h)
/// and which keeps no state outside of its handles; "linear_solver" is then "ma97". Once for the process.
void give_ipopt_sparse_ldlt();

}  // namespace mmgrasp::detail
