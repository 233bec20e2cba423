// Body of chain_kernel_*.cpp, which set MMGRASP_TARGET (attribute of every function) and MMGRASP_LANES and include it,
// through chain_batch.inl, inside an unnamed namespace: nothing here may be merged with code for other machines by the
// linker.

using Lanes = double __attribute__((vector_size(8 * MMGRASP_LANES)));
using LaneBits = long long __attribute__((vector_size(8 * MMGRASP_LANES)));
/// x, y, z and one entry to spare.
using Xyz = double __attribute__((vector_size(32)));
using XyzBits = long long __attribute__((vector_size(32)));

#define MMGRASP_INLINE MMGRASP_TARGET inline __attribute__((always_inline))

MMGRASP_INLINE Xyz spread(double a) {
  return Xyz{a, a, a, a};
}
MMGRASP_INLINE Lanes spread_lanes(double a) {
  Lanes v;
  for (int i = 0; i < MMGRASP_LANES; ++i) v[i] = a;
  return v;
}
MMGRASP_INLINE Xyz load3(const double* a) {
  return Xyz{a[0], a[1], a[2], 0};
}
// Numbers may lie anywhere in memory.
MMGRASP_INLINE Xyz load4(const double* a) {
  Xyz v;
  __builtin_memcpy(&v, a, sizeof v);
  return v;
}
MMGRASP_INLINE void store4(double* a, Xyz v) {
  __builtin_memcpy(a, &v, sizeof v);
}
MMGRASP_INLINE Lanes load_lanes(const double* a) {
  Lanes v;
  __builtin_memcpy(&v, a, sizeof v);
  return v;
}
MMGRASP_INLINE void store_lanes(double* a, Lanes v) {
  __builtin_memcpy(a, &v, sizeof v);
}
MMGRASP_INLINE Xyz cross(Xyz a, Xyz b) {
  const Xyz a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3), b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Xyz c = a * b_yzx - a_yzx * b;
  return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}
/// v and w next to each other at a[0..5].
MMGRASP_INLINE void store_column(double* a, Xyz v, Xyz w) {
  store4(a, v);
  store4(a + 2, __builtin_shufflevector(v, w, 2, 4, 5, 6));
}
MMGRASP_INLINE void add_column(double* a, Xyz v, Xyz w) {
  for (int i = 0; i < 3; ++i) {
    a[i] += v[i];
    a[3 + i] += w[i];
  }
}

constexpr double kLargestAngle = 1e5;  // n x (first part of pi / 2) stays exact well beyond

/// Sine and cosine to about one unit in the last place for |angle| <= kLargestAngle: the nearest multiple of pi / 2 is
/// taken off in three parts, then polynomials of least relative error on [-pi/4, pi/4].
MMGRASP_INLINE void sincos(Lanes angle, Lanes& sine, Lanes& cosine) {
  const double kRound = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds to integers, which its low bits then hold
  const Lanes shifted = angle * 0.63661977236758138 + kRound;
  const LaneBits quadrant = reinterpret_cast<LaneBits>(shifted);
  const Lanes n = shifted - kRound;
  const Lanes r = ((angle - n * 1.5707963267341256) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21;
  const Lanes z = r * r;
  const Lanes s = 0.0083333333333221182 +
                  z * (-0.00019841269829589558 +
                       z * (2.7557313621398746e-06 + z * (-2.5050747765593809e-08 + z * 1.5896230344479878e-10)));
  const Lanes c = -0.0013888888888874138 +
                  z * (2.4801587289491763e-05 +
                       z * (-2.755731435522686e-07 + z * (2.0875723682733631e-09 + z * -1.1359669792158666e-11)));
  const Lanes sin_r = r + r * z * (-0.1666666666666663 + z * s);
  const Lanes half = 0.5 * z, head = 1.0 - half;
  const Lanes cos_r = head + (((1.0 - head) - half) + z * z * (0.041666666666666602 + z * c));
  const LaneBits swap = -(quadrant & 1);
  const LaneBits sin_bits = reinterpret_cast<LaneBits>(sin_r), cos_bits = reinterpret_cast<LaneBits>(cos_r);
  const LaneBits differ = (sin_bits ^ cos_bits) & swap;
  sine = reinterpret_cast<Lanes>((sin_bits ^ differ) ^ ((quadrant & 2) << 62));
  cosine = reinterpret_cast<Lanes>((cos_bits ^ differ) ^ (((quadrant + 1) & 2) << 62));
}

MMGRASP_INLINE Lanes too_large(Lanes angle) {
  return reinterpret_cast<Lanes>((angle > kLargestAngle) | (angle < -kLargestAngle));
}
MMGRASP_INLINE bool any(Lanes mask) {
  const LaneBits bits = reinterpret_cast<LaneBits>(mask);
  long long sum = 0;
  for (int i = 0; i < MMGRASP_LANES; ++i) sum |= bits[i];
  return sum != 0;
}

/// Sines and cosines of all angles of a table for one configuration.
MMGRASP_INLINE void all_sines(const AngleTable& angles, const double* q, double* sines, double* cosines) {
  LaneBits large{};
  for (int i = 0; i < angles.count; i += MMGRASP_LANES) {
    Lanes value;
    for (int k = 0; k < MMGRASP_LANES; ++k) value[k] = q[angles.column[i + k]];
    const Lanes angle = value * load_lanes(angles.multiplier + i) + load_lanes(angles.offset + i);
    large |= reinterpret_cast<LaneBits>(too_large(angle));
    Lanes s, c;
    sincos(angle, s, c);
    store_lanes(sines + i, s);
    store_lanes(cosines + i, c);
  }
  if (__builtin_expect(!any(reinterpret_cast<Lanes>(large)), 1)) return;
  any_sines(angles, q, sines, cosines);
}

struct Axes {
  Xyz x, y, z;
};

MMGRASP_INLINE Xyz times(const Axes& R, const double* v) {
  return R.x * spread(v[0]) + R.y * spread(v[1]) + R.z * spread(v[2]);
}

template <bool kJacobian>
MMGRASP_INLINE void single_body(const Chain& chain, const RootPose& root, const double* q,
                                const SphericalMotion* spherical, double* T, double* J, long stride) {
  alignas(64) double sines[kMaxSegments + kAngleBlock], cosines[kMaxSegments + kAngleBlock];
  all_sines(chain.angles, q, sines, cosines);
  Axes R;
  Xyz p_root;
  if (chain.base) {
    const double s = sines[chain.segments], c = cosines[chain.segments];
    R = {Xyz{c, s, 0, 0}, Xyz{-s, c, 0, 0}, Xyz{0, 0, 1, 0}};
    p_root = Xyz{q[0], q[1], 0, 0};
  } else {
    R = {load3(root.R), load3(root.R + 3), load3(root.R + 6)};
    p_root = load3(root.p);
  }
  // Positions are taken from the root, so that a robot far from the world's origin loses no digits.
  Xyz arm = spread(0);
  Xyz axis[kMaxSegments], origin[kMaxSegments];
  Axes spherical_axes[kMaxSpherical];
  for (int i = 0; i < chain.segments; ++i) {
    const Segment& segment = chain.segment[i];
    const double s = sines[i], c = cosines[i];
    arm += times(R, segment.p);
    if (__builtin_expect(segment.motion == Motion::spherical, 0)) {
      const Xyz y = R.y * spread(segment.tilt_cos) + R.z * spread(segment.tilt_sin);
      R.z = R.z * spread(segment.tilt_cos) - R.y * spread(segment.tilt_sin);
      R.y = y;
      const SphericalMotion& motion = spherical[segment.spherical];
      spherical_axes[segment.spherical] = {times(R, motion.axes), times(R, motion.axes + 3), times(R, motion.axes + 6)};
      origin[i] = arm;
      R = {times(R, motion.R), times(R, motion.R + 3), times(R, motion.R + 6)};
      continue;
    }
    // R times the rotation about x times the one about z, with what does not wait for R multiplied first.
    const Xyz x = R.x * spread(c) + (R.y * spread(s * segment.tilt_cos) + R.z * spread(s * segment.tilt_sin));
    const Xyz y = (R.y * spread(c * segment.tilt_cos) + R.z * spread(c * segment.tilt_sin)) - R.x * spread(s);
    R.z = R.z * spread(segment.tilt_cos) - R.y * spread(segment.tilt_sin);
    R.x = x;
    R.y = y;
    if (kJacobian) {
      axis[i] = R.z;
      origin[i] = arm;
    }
    if (segment.motion == Motion::prismatic)
      arm += R.z * spread(segment.multiplier * q[segment.column] + segment.offset);
  }
  arm += times(R, chain.p_tip);
  store4(T, times(R, chain.R_tip));
  store4(T + 4, times(R, chain.R_tip + 3));
  store4(T + 8, times(R, chain.R_tip + 6));
  const Xyz p = arm + p_root;
  store4(T + 12, Xyz{p[0], p[1], p[2], 1});
  if (!kJacobian) return;
  for (int i = 0; i < chain.segments; ++i) {
    const Segment& segment = chain.segment[i];
    double* column = J + segment.column * stride;
    if (__builtin_expect(segment.motion == Motion::spherical, 0)) {
      const Axes& axes = spherical_axes[segment.spherical];
      store_column(column, cross(axes.x, arm - origin[i]), axes.x);
      store_column(column + stride, cross(axes.y, arm - origin[i]), axes.y);
      store_column(column + 2 * stride, cross(axes.z, arm - origin[i]), axes.z);
      continue;
    }
    const Xyz w = axis[i] * spread(segment.multiplier);
    const Xyz v = segment.motion == Motion::revolute ? cross(w, arm - origin[i]) : w;
    const Xyz turning = segment.motion == Motion::revolute ? w : spread(0);
    if (segment.adds)
      add_column(column, v, turning);
    else
      store_column(column, v, turning);
  }
  for (int i = 0; i < chain.still_columns; ++i) store_column(J + chain.still_column[i] * stride, spread(0), spread(0));
  if (chain.base) {
    store_column(J, Xyz{1, 0, 0, 0}, spread(0));
    store_column(J + stride, Xyz{0, 1, 0, 0}, spread(0));
    store_column(J + 2 * stride, Xyz{-arm[1], arm[0], 0, 0}, Xyz{0, 0, 1, 0});
  }
}

MMGRASP_TARGET void single(const Chain& chain, const RootPose& root, const double* q, const SphericalMotion* spherical,
                           double* T, double* J, long stride) {
  if (J)
    single_body<true>(chain, root, q, spherical, T, J, stride);
  else
    single_body<false>(chain, root, q, spherical, T, J, stride);
}

MMGRASP_INLINE void times_columns(const Axes& R, const double* m, double* out) {
  store4(out, times(R, m));
  store4(out + 4, times(R, m + 4));
  store4(out + 8, times(R, m + 8));
}

MMGRASP_TARGET void frames(const FrameStep* steps, int count, const AngleTable& angles, const double* q, double* T) {
  alignas(64) double sines[kMaxRevolute], cosines[kMaxRevolute];
  all_sines(angles, q, sines, cosines);
  for (const FrameStep* step = steps; step != steps + count; ++step) {
    const double* parent = T + 16 * step->parent;
    double* child = T + 16 * step->frame;
    const Axes R{load4(parent), load4(parent + 4), load4(parent + 8)};
    const double *m = step->A, *p = step->p;
    alignas(32) double local[12];
    switch (step->kind) {
      case FrameStep::Kind::revolute: {
        const Xyz s = spread(sines[step->angle]), c = spread(cosines[step->angle]);
        for (int k = 0; k < 12; k += 4)
          store4(local + k, load4(step->A + k) + (s * load4(step->B + k) + c * load4(step->C + k)));
        m = local;
        break;
      }
      case FrameStep::Kind::prismatic:
        store4(local, load4(step->p) + spread(step->multiplier * q[step->column] + step->offset) * load4(step->d));
        p = local;
        break;
      case FrameStep::Kind::spherical: {
        alignas(32) double turn[12];
        rotation_columns(q + step->column, turn);
        times_columns({load4(step->A), load4(step->A + 4), load4(step->A + 8)}, turn, local);
        m = local;
        break;
      }
      case FrameStep::Kind::fixed:
        break;
    }
    times_columns(R, m, child);
    store4(child + 12, load4(parent + 12) + times(R, p));
  }
}
