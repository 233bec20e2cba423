// The second part of chain_kernel_*.cpp: the same arithmetic with a configuration in every lane.

#include "robot/kinematics/chain_kernel.inl"

struct Lanes3 {
  Lanes x, y, z;
};

MMGRASP_INLINE Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
MMGRASP_INLINE Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
MMGRASP_INLINE Lanes3 operator*(const Lanes3& a, Lanes b) {
  return {a.x * b, a.y * b, a.z * b};
}
MMGRASP_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
MMGRASP_INLINE Lanes3 constant(double x, double y, double z) {
  return {spread_lanes(x), spread_lanes(y), spread_lanes(z)};
}

struct LaneAxes {
  Lanes3 x, y, z;
};

MMGRASP_INLINE Lanes3 times(const LaneAxes& R, const double* v) {
  return R.x * spread_lanes(v[0]) + R.y * spread_lanes(v[1]) + R.z * spread_lanes(v[2]);
}

/// Entry `column` of every configuration.
MMGRASP_INLINE Lanes gather(const double* q, long stride, int column) {
  Lanes v;
  for (int i = 0; i < MMGRASP_LANES; ++i) v[i] = q[i * stride + column];
  return v;
}

#if MMGRASP_LANES == 8
MMGRASP_INLINE Xyz four_of(Lanes v, int first) {
  return first ? __builtin_shufflevector(v, v, 4, 5, 6, 7) : __builtin_shufflevector(v, v, 0, 1, 2, 3);
}
#endif

/// rows[0..3] of every lane, to out, out + stride, ...
MMGRASP_INLINE void scatter4(const Lanes* rows, double* out, long stride) {
#if MMGRASP_LANES == 2
  for (int r = 0; r < 4; r += 2) {
    store_lanes(out + r, __builtin_shufflevector(rows[r], rows[r + 1], 0, 2));
    store_lanes(out + stride + r, __builtin_shufflevector(rows[r], rows[r + 1], 1, 3));
  }
#else
  for (int first = 0; first < MMGRASP_LANES; first += 4) {
#if MMGRASP_LANES == 4
    const Xyz a = rows[0], b = rows[1], c = rows[2], d = rows[3];
#else
    const Xyz a = four_of(rows[0], first), b = four_of(rows[1], first), c = four_of(rows[2], first),
              d = four_of(rows[3], first);
#endif
    const Xyz ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Xyz cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    store4(out + (first + 0) * stride, __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5));
    store4(out + (first + 1) * stride, __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5));
    store4(out + (first + 2) * stride, __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7));
    store4(out + (first + 3) * stride, __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7));
  }
#endif
}

MMGRASP_INLINE void scatter_pose(const Lanes3& x, const Lanes3& y, const Lanes3& z, const Lanes3& p, double* T) {
  const Lanes zero = spread_lanes(0);
  const Lanes rows[16] = {x.x, x.y, x.z, zero, y.x, y.y, y.z, zero, z.x, z.y, z.z, zero, p.x, p.y, p.z, zero + 1.0};
  for (int r = 0; r < 16; r += 4) scatter4(rows + r, T + r, 16);
}

/// Where the lanes' tips and columns are worked out.
struct LaneScratch {
  Lanes3 axis[kMaxSegments], origin[kMaxSegments];
  Lanes J[6 * kMaxColumns];
};

MMGRASP_INLINE void set_column(Lanes* J, const Lanes3& v, const Lanes3& w) {
  J[0] = v.x;
  J[1] = v.y;
  J[2] = v.z;
  J[3] = w.x;
  J[4] = w.y;
  J[5] = w.z;
}

MMGRASP_INLINE void lane_jacobian(const Chain& chain, const Lanes3& arm, LaneScratch& scratch) {
  const Lanes3 none = constant(0, 0, 0);
  for (int i = 0; i < chain.segments; ++i) {
    const Segment& segment = chain.segment[i];
    Lanes* column = scratch.J + 6 * segment.column;
    const Lanes3 w = scratch.axis[i] * spread_lanes(segment.multiplier);
    const bool revolute = segment.motion == Motion::revolute;
    const Lanes3 v = revolute ? cross(w, arm - scratch.origin[i]) : w;
    const Lanes3 turning = revolute ? w : none;
    if (segment.adds)
      set_column(column, Lanes3{column[0], column[1], column[2]} + v,
                 Lanes3{column[3], column[4], column[5]} + turning);
    else
      set_column(column, v, turning);
  }
  for (int i = 0; i < chain.still_columns; ++i) set_column(scratch.J + 6 * chain.still_column[i], none, none);
  if (!chain.base) return;
  set_column(scratch.J, constant(1, 0, 0), none);
  set_column(scratch.J + 6, constant(0, 1, 0), none);
  set_column(scratch.J + 12, {-arm.y, arm.x, none.x}, constant(0, 0, 1));
}

/// Entry i of the table for every configuration.
MMGRASP_INLINE void sine_lanes(const AngleTable& angles, int i, const double* q, long stride, Lanes& sine,
                               Lanes& cosine, LaneBits& large) {
  const Lanes angle = gather(q, stride, angles.column[i]) * angles.multiplier[i] + angles.offset[i];
  large |= reinterpret_cast<LaneBits>(too_large(angle));
  sincos(angle, sine, cosine);
}

/// False when some angle is too large for the polynomials: nothing that was written is right then.
template <bool kJacobian>
MMGRASP_INLINE bool lanes_body(const Chain& chain, const RootPose& root, const double* q, long stride, double* T,
                               double* J, LaneScratch& scratch) {
  LaneBits large{};
  LaneAxes R{constant(root.R[0], root.R[1], root.R[2]), constant(root.R[3], root.R[4], root.R[5]),
             constant(root.R[6], root.R[7], root.R[8])};
  Lanes3 p_root = constant(root.p[0], root.p[1], root.p[2]);
  if (chain.base) {
    Lanes s, c;
    sine_lanes(chain.angles, chain.segments, q, stride, s, c, large);
    const Lanes zero = spread_lanes(0);
    R = {{c, s, zero}, {-s, c, zero}, constant(0, 0, 1)};
    p_root = {gather(q, stride, 0), gather(q, stride, 1), zero};
  }
  Lanes3 arm = constant(0, 0, 0);
  for (int i = 0; i < chain.segments; ++i) {
    const Segment& segment = chain.segment[i];
    Lanes s, c;
    sine_lanes(chain.angles, i, q, stride, s, c, large);
    arm = arm + times(R, segment.p);
    const Lanes tilt_c = spread_lanes(segment.tilt_cos), tilt_s = spread_lanes(segment.tilt_sin);
    const Lanes3 y = R.y * tilt_c + R.z * tilt_s;
    R.z = R.z * tilt_c - R.y * tilt_s;
    R.y = y * c - R.x * s;
    R.x = R.x * c + y * s;
    if (kJacobian) {
      scratch.axis[i] = R.z;
      scratch.origin[i] = arm;
    }
    if (segment.motion == Motion::prismatic)
      arm = arm + R.z * (gather(q, stride, segment.column) * segment.multiplier + segment.offset);
  }
  if (any(reinterpret_cast<Lanes>(large))) return false;
  arm = arm + times(R, chain.p_tip);
  scatter_pose(times(R, chain.R_tip), times(R, chain.R_tip + 3), times(R, chain.R_tip + 6), arm + p_root, T);
  if (!kJacobian) return true;
  lane_jacobian(chain, arm, scratch);
  const int rows = 6 * chain.columns;
  for (int r = 0; r + 4 <= rows; r += 4) scatter4(scratch.J + r, J + r, rows);
  if (rows % 4 != 0) scatter4(scratch.J + rows - 4, J + rows - 4, rows);  // two of these rows once more
  return true;
}

MMGRASP_TARGET void batch(const Chain& chain, const RootPose& root, const double* q, long stride, long blocks,
                          double* T, double* J) {
  LaneScratch scratch;
  const long rows = 6 * chain.columns;
  for (long block = 0; block < blocks; ++block) {
    const bool done = J ? lanes_body<true>(chain, root, q, stride, T, J, scratch)
                        : lanes_body<false>(chain, root, q, stride, T, J, scratch);
    if (!done) {
      for (int i = 0; i < MMGRASP_LANES; ++i)
        single(chain, root, q + i * stride, nullptr, T + 16 * i, J ? J + rows * i : nullptr, 6);
    }
    q += MMGRASP_LANES * stride;
    T += MMGRASP_LANES * 16;
    if (J) J += MMGRASP_LANES * rows;
  }
}
