#include "optim/nlp/ipopt_factorisation.hpp"

#include <HSLLoader.h>

#include <memory>
#include <mutex>
#include <new>
#include <optional>

#include "optim/sparse/sparse_ldlt.hpp"

// What HSL_MA97's users set and read. HSLLoader.h declares both, Ipopt's Ma97SolverInterface has them as members.
struct ma97_control_d {
  int f_arrays, action, nemin;
  double multiplier;
  int ordering, print_level, scaling;
  double small, u;
  int unit_diagnostics, unit_error, unit_warning;
  long factor_min;
  int solve_blas3;
  long solve_min;
  int solve_mf;
  double consist_tol;
  int ispare[5];
  double rspare[10];
};
struct ma97_info_d {
  int flag, flag68, flag77, matrix_dup, matrix_rank, matrix_outrange, matrix_missing_diag, maxdepth, maxfront,
      num_delay;
  long num_factor, num_flops;
  int num_neg, num_sup, num_two, ordering, stat;
  int ispare[5];
  double rspare[10];
};

namespace mmgrasp::detail {
namespace {

constexpr int kNoMemory = -1, kSingular = -7;

SparseLdlt& ldlt_of(void** handle) {
  return *static_cast<SparseLdlt*>(*handle);
}

/// Exceptions do not pass through Ipopt's C interface.
template <typename Work>
void guarded(ma97_info* info, Work&& work) {
  *info = {};
  try {
    work();
  } catch (const std::bad_alloc&) {
    info->flag = kNoMemory;
  }
}

void default_control(ma97_control* control) {
  *control = {};
  control->f_arrays = 1;
  control->u = 1e-8;
  control->small = 1e-20;
}

void analyse(int, int n, const int starts[], const int rows[], double[], void** handle, const ma97_control* control,
             ma97_info* info, int[]) {
  guarded(info, [&] {
    const int base = control->f_arrays ? 1 : 0;
    LowerColumns pattern;
    pattern.starts.assign(starts, starts + n + 1);
    pattern.rows.assign(rows, rows + (starts[n] - base));
    for (int& start : pattern.starts) start -= base;
    for (int& row : pattern.rows) row -= base;
    delete static_cast<SparseLdlt*>(*handle);
    *handle = nullptr;
    *handle = new SparseLdlt(pattern);
  });
}

void factor(int, const int[], const int[], const double values[], void** handle, void**, const ma97_control* control,
            ma97_info* info, const double[]) {
  guarded(info, [&] {
    SparseLdlt& ldlt = ldlt_of(handle);
    if (!ldlt.factor(values, control->u, control->small)) info->flag = kSingular;
    info->num_neg = ldlt.negative();
    info->num_delay = ldlt.waited();
    info->maxfront = ldlt.largest_front();
  });
}

void solve(int, int columns, double x[], int stride, void** handle, void**, const ma97_control*, ma97_info* info) {
  // What factor() found is read after solve() as well: only the flag is written.
  info->flag = 0;
  for (int i = 0; i < columns; ++i) ldlt_of(handle).solve(x + static_cast<std::ptrdiff_t>(i) * stride);
}

void factor_solve(int type, const int starts[], const int rows[], const double values[], int columns, double x[],
                  int stride, void** handle, void** factors, const ma97_control* control, ma97_info* info,
                  const double scale[]) {
  factor(type, starts, rows, values, handle, factors, control, info, scale);
  if (info->flag == 0) solve(0, columns, x, stride, handle, factors, control, info);
}

void free_analysis(void** handle) {
  delete static_cast<SparseLdlt*>(*handle);
  *handle = nullptr;
}

void finalise(void** handle, void** factors) {
  free_analysis(handle);
  *factors = nullptr;
}

}  // namespace

void give_ipopt_sparse_ldlt() {
  static std::once_flag given;
  std::call_once(given, [] {
    LSL_setMA97(&default_control, &analyse, &factor, &factor_solve, &solve, &finalise, &free_analysis);
  });
}

}  // namespace mmgrasp::detail
