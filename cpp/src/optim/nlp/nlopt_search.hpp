#pragma once

#include <memory>

#include "mmgrasp/optim/derivative_free.hpp"

namespace mmgrasp::detail {

std::unique_ptr<DerivativeFreeSolver> make_bobyqa();
std::unique_ptr<DerivativeFreeSolver> make_cobyla();
std::unique_ptr<DerivativeFreeSolver> make_nelder_mead();
std::unique_ptr<DerivativeFreeSolver> make_sbplx();
std::unique_ptr<DerivativeFreeSolver> make_crs2();
std::unique_ptr<DerivativeFreeSolver> make_isres();
std::unique_ptr<DerivativeFreeSolver> make_direct_l();
std::unique_ptr<DerivativeFreeSolver> make_esch();

}  // namespace mmgrasp::detail
