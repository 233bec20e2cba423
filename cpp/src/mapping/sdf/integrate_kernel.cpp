#include "mapping/sdf/integrate_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/instruction_set.hpp"

#ifdef MMGRASP_X86_KERNELS
#include <immintrin.h>
#endif

// Compiled with -ffp-contract=off (CMakeLists.txt): a fused product would make the sets of instructions differ.
namespace mmgrasp::detail {
namespace {

constexpr int kLanes = 8;  // voxels of a row

constexpr int kSure = 3;  // frames that make a voxel one that can be contradicted

/// A frame more that saw a voxel near a surface; at the limit one less that looked through it.
void count_near(std::uint8_t& near, std::uint8_t& free, int persistence) {
  if (near < persistence) {
    ++near;
  } else if (free > 0) {
    --free;
  }
}

void count_free(std::uint8_t near, std::uint8_t& free, int persistence) {
  if (free < std::min(255, near + persistence)) ++free;
}

bool contradicts(const KernelFrame& f, float off, float old, float weight) {
  return off * off * (old * weight) > f.gate_squared * (old + weight) && std::abs(off) > f.gate_least;
}

/// Keeps a voxel as it is, until more frames contradict than saw it: then the last one counts alone.
void contradict(KernelBlock& b, int row, int x, float d, float weight, int persistence) {
  const int i = row * kLanes + x;
  ++b.contradicted;
  count_free(b.near[i], b.free[i], persistence);
  b.looked_through = true;
  if (b.free[i] <= b.near[i]) return;
  b.rows[row * 2 * kLanes + x] = d;
  b.rows[row * 2 * kLanes + kLanes + x] = weight;
  b.near[i] = 1;
  b.free[i] = 0;
}

/// Sums a row's lanes in an order that both versions keep.
float total(const float* lane) {
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

void integrate_portable(const KernelFrame& f, KernelBlock& b) {
  float sums[3][kLanes] = {};
  for (int row = 0; row < kLanes * kLanes; ++row) {
    const float y = static_cast<float>(row & 7), z = static_cast<float>(row >> 3);
    float base[3];
    for (int k = 0; k < 3; ++k) base[k] = b.origin[k] + (f.step[1][k] * y + f.step[2][k] * z);
    for (int x = 0; x < kLanes; ++x) {
      const float X = base[0] + f.step[0][0] * static_cast<float>(x);
      const float Y = base[1] + f.step[0][1] * static_cast<float>(x);
      const float Z = base[2] + f.step[0][2] * static_cast<float>(x);
      if (!(Z > f.nearest)) continue;
      const float inverse = 1.0f / Z;
      const float u = X * f.fx * inverse + f.cx, v = Y * f.fy * inverse + f.cy;
      if (!(u >= 0 && u < static_cast<float>(f.width) && v >= 0 && v < static_cast<float>(f.height))) continue;
      const int at = static_cast<int>(v) * f.width + static_cast<int>(u);
      const PixelPlane& pixel = f.pixels[at];
      const int i = row * kLanes + x;
      if (Z < pixel.free_depth) {
        if (b.near[i] > 0) {
          count_free(b.near[i], b.free[i], f.persistence);
          b.looked_through = true;
        }
        continue;
      }
      const float d = ((pixel.n[0] * X + pixel.n[1] * Y) + pixel.n[2] * Z) - pixel.c;
      if (!f.surfaces || !(std::abs(d) <= pixel.reach)) continue;
      float& mean = b.rows[row * 2 * kLanes + x];
      float& weight = b.rows[row * 2 * kLanes + kLanes + x];
      const float sum = weight + pixel.weight;
      if (f.gate_squared > 0 && b.near[i] >= kSure && contradicts(f, d - mean, weight, pixel.weight)) {
        contradict(b, row, x, d, pixel.weight, f.persistence);
        continue;
      }
      mean = mean + (d - mean) * (pixel.weight / sum);
      weight = sum;
      count_near(b.near[i], b.free[i], f.persistence);
      sums[0][x] += pixel.weight;
      sums[1][x] += f.shares ? f.shares[at].white : pixel.weight;
      sums[2][x] += f.shares ? f.shares[at].systematic : 0;
      b.touched = true;
    }
  }
  b.sum_weight = total(sums[0]);
  b.sum_white = total(sums[1]);
  b.sum_systematic = total(sums[2]);
}

#ifdef MMGRASP_X86_KERNELS
/// Ones in the bytes whose bit is set.
struct ByteTable {
  std::uint64_t bytes[256];
  constexpr ByteTable() : bytes() {
    for (int mask = 0; mask < 256; ++mask) {
      for (int bit = 0; bit < 8; ++bit) {
        if (mask >> bit & 1) bytes[mask] |= std::uint64_t{1} << (8 * bit);
      }
    }
  }
};
constexpr ByteTable kBytes;

/// count_near() in the row's lanes of the mask.
__attribute__((target("avx2"))) void count_near(std::uint8_t* near, std::uint8_t* free, int mask, int persistence) {
  const __m128i old = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(near));
  const __m128i one = _mm_cvtsi64_si128(static_cast<long long>(kBytes.bytes[mask]));
  const __m128i limit = _mm_set1_epi8(static_cast<char>(persistence));
  const __m128i full = _mm_cmpeq_epi8(_mm_max_epu8(old, limit), old);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(near), _mm_adds_epu8(old, _mm_andnot_si128(full, one)));
  const __m128i less = _mm_and_si128(full, one);
  if (_mm_cvtsi128_si64(less) == 0) return;
  auto* const place = reinterpret_cast<__m128i*>(free);
  _mm_storel_epi64(place, _mm_subs_epu8(_mm_loadl_epi64(place), less));
}

/// count_free() in the lanes of the mask that were near a surface; whether there was one.
__attribute__((target("avx2"))) bool count_free(const std::uint8_t* near, std::uint8_t* free, int mask,
                                                int persistence) {
  const __m128i seen = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(near));
  const __m128i old = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(free));
  const __m128i lanes = _mm_andnot_si128(_mm_cmpeq_epi8(seen, _mm_setzero_si128()),
                                         _mm_cvtsi64_si128(static_cast<long long>(kBytes.bytes[mask])));
  // Not where free - persistence >= near.
  const __m128i ahead = _mm_subs_epu8(old, _mm_set1_epi8(static_cast<char>(persistence)));
  const __m128i full = _mm_cmpeq_epi8(_mm_max_epu8(ahead, seen), ahead);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(free), _mm_adds_epu8(old, _mm_andnot_si128(full, lanes)));
  return _mm_cvtsi128_si64(lanes) != 0;
}

/// The lanes of `near` that contradict what three frames or more saw.
__attribute__((target("avx2"))) __m256 contradicting(const KernelFrame& f, const std::uint8_t* frames, __m256 near,
                                                     __m256 off, __m256 old, __m256 weight) {
  const __m256i count = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(frames)));
  const __m256 sure = _mm256_castsi256_ps(_mm256_cmpgt_epi32(count, _mm256_set1_epi32(kSure - 1)));
  const __m256 far =
      _mm256_cmp_ps(_mm256_mul_ps(_mm256_mul_ps(off, off), _mm256_mul_ps(old, weight)),
                    _mm256_mul_ps(_mm256_set1_ps(f.gate_squared), _mm256_add_ps(old, weight)), _CMP_GT_OQ);
  const __m256 apart =
      _mm256_cmp_ps(_mm256_andnot_ps(_mm256_set1_ps(-0.0f), off), _mm256_set1_ps(f.gate_least), _CMP_GT_OQ);
  return _mm256_and_ps(_mm256_and_ps(near, sure), _mm256_and_ps(far, apart));
}

/// contradict() in the lanes of the mask.
__attribute__((target("avx2"))) void contradict(const KernelFrame& f, KernelBlock& b, int row, int mask, __m256 d,
                                                __m256 weight) {
  alignas(32) float ds[kLanes], weights[kLanes];
  _mm256_store_ps(ds, d);
  _mm256_store_ps(weights, weight);
  for (int x = 0; x < kLanes; ++x) {
    if (mask >> x & 1) contradict(b, row, x, ds[x], weights[x], f.persistence);
  }
}

__attribute__((target("avx2"))) void integrate_avx2(const KernelFrame& f, KernelBlock& b) {
  const __m256 lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256 step_x = _mm256_mul_ps(_mm256_set1_ps(f.step[0][0]), lane),
               step_y = _mm256_mul_ps(_mm256_set1_ps(f.step[0][1]), lane),
               step_z = _mm256_mul_ps(_mm256_set1_ps(f.step[0][2]), lane);
  const __m256 zero = _mm256_setzero_ps(), nearest = _mm256_set1_ps(f.nearest);
  const __m256 fx = _mm256_set1_ps(f.fx), fy = _mm256_set1_ps(f.fy), cx = _mm256_set1_ps(f.cx),
               cy = _mm256_set1_ps(f.cy);
  const __m256 width = _mm256_set1_ps(static_cast<float>(f.width)),
               height = _mm256_set1_ps(static_cast<float>(f.height));
  const __m256 sign = _mm256_set1_ps(-0.0f);
  const __m256i columns = _mm256_set1_epi32(f.width);
  const auto* const pixels = reinterpret_cast<const float*>(f.pixels);
  const auto* const shares = reinterpret_cast<const float*>(f.shares);
  __m256 sum_weight = zero, sum_white = zero, sum_systematic = zero;
  for (int row = 0; row < kLanes * kLanes; ++row) {
    const float y = static_cast<float>(row & 7), z = static_cast<float>(row >> 3);
    float base[3];
    for (int k = 0; k < 3; ++k) base[k] = b.origin[k] + (f.step[1][k] * y + f.step[2][k] * z);
    const __m256 X = _mm256_add_ps(_mm256_set1_ps(base[0]), step_x), Y = _mm256_add_ps(_mm256_set1_ps(base[1]), step_y),
                 Z = _mm256_add_ps(_mm256_set1_ps(base[2]), step_z);
    const __m256 inverse = _mm256_div_ps(_mm256_set1_ps(1.0f), Z);
    const __m256 u = _mm256_add_ps(_mm256_mul_ps(_mm256_mul_ps(X, fx), inverse), cx),
                 v = _mm256_add_ps(_mm256_mul_ps(_mm256_mul_ps(Y, fy), inverse), cy);
    __m256 seen = _mm256_cmp_ps(Z, nearest, _CMP_GT_OQ);
    seen = _mm256_and_ps(seen, _mm256_cmp_ps(u, zero, _CMP_GE_OQ));
    seen = _mm256_and_ps(seen, _mm256_cmp_ps(u, width, _CMP_LT_OQ));
    seen = _mm256_and_ps(seen, _mm256_cmp_ps(v, zero, _CMP_GE_OQ));
    seen = _mm256_and_ps(seen, _mm256_cmp_ps(v, height, _CMP_LT_OQ));
    if (_mm256_movemask_ps(seen) == 0) continue;
    const __m256i pixel = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_cvttps_epi32(v), columns), _mm256_cvttps_epi32(u));
    const __m256i at = _mm256_and_si256(_mm256_slli_epi32(pixel, 3), _mm256_castps_si256(seen));
    const __m256 free = _mm256_and_ps(seen, _mm256_cmp_ps(Z, _mm256_i32gather_ps(pixels, at, 4), _CMP_LT_OQ));
    const int free_lanes = _mm256_movemask_ps(free);
    if (free_lanes != 0 && count_free(b.near + row * kLanes, b.free + row * kLanes, free_lanes, f.persistence)) {
      b.looked_through = true;
    }
    if (!f.surfaces) continue;
    const __m256 reach = _mm256_i32gather_ps(pixels + 6, at, 4);
    __m256 near = _mm256_andnot_ps(free, _mm256_and_ps(seen, _mm256_cmp_ps(reach, zero, _CMP_GT_OQ)));
    if (_mm256_movemask_ps(near) == 0) continue;
    const __m256 nx = _mm256_i32gather_ps(pixels + 1, at, 4), ny = _mm256_i32gather_ps(pixels + 2, at, 4),
                 nz = _mm256_i32gather_ps(pixels + 3, at, 4), c = _mm256_i32gather_ps(pixels + 4, at, 4);
    const __m256 across =
        _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(nx, X), _mm256_mul_ps(ny, Y)), _mm256_mul_ps(nz, Z));
    const __m256 d = _mm256_sub_ps(across, c);
    near = _mm256_and_ps(near, _mm256_cmp_ps(_mm256_andnot_ps(sign, d), reach, _CMP_LE_OQ));
    int near_lanes = _mm256_movemask_ps(near);
    if (near_lanes == 0) continue;
    const __m256 weight = _mm256_i32gather_ps(pixels + 5, at, 4);
    float* const means = b.rows + row * 2 * kLanes;
    float* const weights = means + kLanes;
    if (f.gate_squared > 0) {
      const __m256 off = _mm256_sub_ps(d, _mm256_load_ps(means));
      const __m256 against = contradicting(f, b.near + row * kLanes, near, off, _mm256_load_ps(weights), weight);
      const int lanes = _mm256_movemask_ps(against);
      if (lanes != 0) {
        contradict(f, b, row, lanes, d, weight);
        near = _mm256_andnot_ps(against, near);
        near_lanes &= ~lanes;
        if (near_lanes == 0) continue;
      }
    }
    const __m256 mean = _mm256_load_ps(means), old = _mm256_load_ps(weights), sum = _mm256_add_ps(old, weight);
    const __m256 updated = _mm256_add_ps(mean, _mm256_mul_ps(_mm256_sub_ps(d, mean), _mm256_div_ps(weight, sum)));
    _mm256_store_ps(means, _mm256_blendv_ps(mean, updated, near));
    _mm256_store_ps(weights, _mm256_blendv_ps(old, sum, near));
    count_near(b.near + row * kLanes, b.free + row * kLanes, near_lanes, f.persistence);
    sum_weight = _mm256_add_ps(sum_weight, _mm256_and_ps(near, weight));
    if (shares) {
      const __m256i pair = _mm256_srli_epi32(at, 2);
      sum_white = _mm256_add_ps(sum_white, _mm256_and_ps(near, _mm256_i32gather_ps(shares, pair, 4)));
      sum_systematic = _mm256_add_ps(sum_systematic, _mm256_and_ps(near, _mm256_i32gather_ps(shares + 1, pair, 4)));
    }
    b.touched = true;
  }
  alignas(32) float lanes[kLanes];
  _mm256_store_ps(lanes, sum_weight);
  b.sum_weight = total(lanes);
  _mm256_store_ps(lanes, shares ? sum_white : sum_weight);
  b.sum_white = total(lanes);
  _mm256_store_ps(lanes, sum_systematic);
  b.sum_systematic = total(lanes);
}
#endif

}  // namespace

void integrate_block(const KernelFrame& frame, KernelBlock& block) {
#ifdef MMGRASP_X86_KERNELS
  if (instruction_set() != InstructionSet::portable) return integrate_avx2(frame, block);
#endif
  integrate_portable(frame, block);
}

}  // namespace mmgrasp::detail
