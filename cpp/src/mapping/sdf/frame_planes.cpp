#include "mapping/sdf/frame_planes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "mapping/sdf/speckles.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

using Vector3f = Eigen::Vector3f;
constexpr int kBand = 16;  // rows of a work item
constexpr int kMostRadius = 8;
/// Two depths of one surface differ by more than this many standard deviations once in millions.
constexpr float kJumpSigmas = 6;
/// Standard deviation of a normal's slope that the window is chosen for.
constexpr double kSlopeSigma = 0.07;

/// A depth speaks for voxels that interpolation at the surface needs, and as far again as noise moves them: farther
/// away other faces may be nearer, and would be pulled off their place.
constexpr float kCellReach = 1.75f, kNoiseReach = 2.0f;

enum class Fate : std::uint8_t { missing, used, out_of_range, too_noisy, without_normal, too_slanted, outlier };

struct RowSums {
  float sum, moment, squares;
};

/// The plane of a window, in inverse depths: q + su (u - u0) + sv (v - v0).
struct WindowFit {
  float su = 0, sv = 0, q = 0;
  float misfit = -1;  ///< Mean squared residual over the noise's; negative where there is no whole window.
};
}  // namespace

struct PlaneScratch {  // Row by row as the image.
  std::vector<float> q, rim;
  std::vector<RowSums> rows;
  std::vector<WindowFit> fits;
  std::vector<std::uint8_t> broken;
  std::vector<int> integral;
  std::vector<Fate> fate;
};

namespace {

/// More than noise makes of it in a window of this size.
constexpr float kGoodFit = 1.4f;

/// Fits a plane to the neighbours of every pixel on the same surface, and finds how uncertain its depth is.
class PlaneFitter {
 public:
  PlaneFitter(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty,
              const SdfOptions& options, PlaneScratch& scratch, FramePlanes& out)
      : image_(image),
        camera_(camera),
        uncertainty_(uncertainty),
        options_(options),
        width_(image.camera.width),
        height_(image.camera.height),
        fx_(static_cast<float>(image.camera.fx)),
        fy_(static_cast<float>(image.camera.fy)),
        q_(scratch.q),
        rim_(scratch.rim),
        rows_(scratch.rows),
        fits_(scratch.fits),
        broken_(scratch.broken),
        integral_(scratch.integral),
        fate_(scratch.fate),
        out_(out) {
    slope_limit_ = static_cast<float>(std::tan(options.max_incidence));
    least_cosine_ = static_cast<float>(std::cos(options.max_incidence));
    const Eigen::Matrix3d R = image.T_world_camera.linear();
    Eigen::Matrix<double, 6, 6> rotation = Eigen::Matrix<double, 6, 6>::Zero();
    rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = R.transpose();
    covariance_ = (rotation * uncertainty.pose_covariance * rotation.transpose()).cast<float>();
    pose_is_exact_ = covariance_.isZero(0);
    shared_ = !pose_is_exact_ || camera.systematic > 0 || camera.systematic_scale > 0;
  }

  void fit() {
    const std::size_t pixels = image_.depth.size();
    sort_depths();
    if (options_.outlier_gate > 0) {
      speckles_ = fill_speckles(q_, width_, height_, [&](std::size_t i, std::size_t j) { return joined(i, j, 1); });
    }
    broken_.resize(pixels);
    rim_.resize(pixels);
    rows_.resize(pixels);
    fits_.resize(pixels);
    fate_.resize(pixels);
    out_.planes.resize(pixels);
    out_.bands.resize(pixels);
    out_.shares.resize(shared_ ? pixels : 0);
    bands([&](int v) {
      break_row(v);
      sum_row(v);
    });
    sum_broken();
    bands([&](int v) { fit_row(v); }, [&] { measure_rims(); });
    bands([&](int v) {
      for (int u = 0; u < width_; ++u) fate_[index(u, v)] = plane_of(u, v);
    });
    count();
  }

 private:
  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v) * width_ + u; }

  /// All rows; `beside` is done meanwhile.
  template <typename Row>
  void bands(const Row& row, const std::function<void()>& beside = {}) const {
    const int others = beside ? 1 : 0;
    parallel_for(others + (height_ + kBand - 1) / kBand, options_.threads, [&](std::size_t item, int) {
      if (static_cast<int>(item) < others) return beside();
      const int first = (static_cast<int>(item) - others) * kBand;
      for (int v = first; v < std::min(first + kBand, height_); ++v) row(v);
    });
  }

  float axial_sigma(std::size_t i, float z) const {
    if (!uncertainty_.sigma.empty()) return uncertainty_.sigma[i];
    return static_cast<float>(camera_.noise.constant + z * (camera_.noise.linear + z * camera_.noise.quadratic));
  }

  /// Inverse depths, in which planes are linear over the image; the window by the median noise.
  void sort_depths() {
    const PinholeCamera& c = image_.camera;
    q_.resize(image_.depth.size());
    std::vector<float> some, ratios;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const float z = image_.depth[i];
      const bool seen = z >= c.nearest && z <= c.farthest;
      q_[i] = seen ? 1 / z : 0;
      if (!seen || i % 61 != 0) continue;
      some.push_back(z);
      ratios.push_back(axial_sigma(i, z) * fx_ / z);
    }
    const auto median = [](std::vector<float>& values) {
      if (values.empty()) return 1.0f;
      std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
      return values[values.size() / 2];
    };
    const double ratio = median(ratios);
    out_.median_depth = median(some);
    radius_ = 2;
    while (radius_ < kMostRadius &&
           ratio / ((2 * radius_ + 1) * std::sqrt(radius_ * (radius_ + 1) / 3.0)) > kSlopeSigma)
      ++radius_;
  }

  /// Whether two pixels this far apart [pixels] may lie on one surface.
  bool joined(std::size_t i, std::size_t j, float apart) const {
    const float z = 1 / q_[i];
    return std::abs(z - 1 / q_[j]) <= kJumpSigmas * axial_sigma(i, z) + slope_limit_ * z / fx_ * apart;
  }

  /// Marks pixels without a depth, or not on one surface with the next to the right or below.
  void break_row(int v) {
    for (int u = 0; u < width_; ++u) {
      const std::size_t i = index(u, v);
      const auto parted = [&](std::size_t j) { return q_[j] > 0 && !joined(i, j, 1); };
      broken_[i] = q_[i] == 0 || (u + 1 < width_ && parted(i + 1)) || (v + 1 < height_ && parted(i + width_));
    }
  }

  /// Integral image of the marks, one row and column larger.
  void sum_broken() {
    integral_.resize(static_cast<std::size_t>(width_ + 1) * (height_ + 1));
    std::fill_n(integral_.begin(), width_ + 1, 0);
    for (int v = 0; v < height_; ++v) {
      int row = 0;
      int* below = &integral_[static_cast<std::size_t>(v + 1) * (width_ + 1)];
      const int* above = below - (width_ + 1);
      below[0] = 0;
      for (int u = 0; u < width_; ++u) {
        row += broken_[index(u, v)];
        below[u + 1] = above[u + 1] + row;
      }
    }
  }

  /// Distance of every pixel from the next break [pixels], by the chamfer metric.
  void measure_rims() {
    const float beside = 1, across = std::sqrt(2.0f), far = static_cast<float>(width_ + height_);
    const auto at = [&](int u, int v) {
      return u < 0 || v < 0 || u >= width_ || v >= height_ ? far : rim_[index(u, v)];
    };
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) {
        const float before = std::min(std::min(at(u - 1, v), at(u, v - 1)) + beside,
                                      std::min(at(u - 1, v - 1), at(u + 1, v - 1)) + across);
        rim_[index(u, v)] = broken_[index(u, v)] ? 0.5f : std::min(far, before);
      }
    }
    for (int v = height_ - 1; v >= 0; --v) {
      for (int u = width_ - 1; u >= 0; --u) {
        const float after = std::min(std::min(at(u + 1, v), at(u, v + 1)) + beside,
                                     std::min(at(u + 1, v + 1), at(u - 1, v + 1)) + across);
        rim_[index(u, v)] = std::min(rim_[index(u, v)], after);
      }
    }
  }

  bool whole_window(int u, int v) const {
    const int r = radius_;
    if (u < r || v < r || u + r >= width_ || v + r >= height_) return false;
    const auto at = [&](int x, int y) { return integral_[static_cast<std::size_t>(y) * (width_ + 1) + x]; };
    return at(u + r + 1, v + r + 1) - at(u - r, v + r + 1) - at(u + r + 1, v - r) + at(u - r, v - r) == 0;
  }

  /// Sums over the columns u + k of the window, of differences to q(u): small numbers, or the squares would drown.
  void sum_row(int v) {
    const float* const q = &q_[index(0, v)];
    RowSums* const sums = &rows_[index(0, v)];
    for (int u = radius_; u < width_ - radius_; ++u) {
      float sum = 0, moment = 0, squares = 0;
      for (int k = 1; k <= radius_; ++k) {
        const float right = q[u + k] - q[u], left = q[u - k] - q[u];
        sum += right + left;
        moment += static_cast<float>(k) * (right - left);
        squares += right * right + left * left;
      }
      sums[u] = {sum, moment, squares};
    }
  }

  /// Least squares over every window that is wholly on one surface.
  void fit_row(int v) {
    const float side = static_cast<float>(2 * radius_ + 1), n = side * side;
    const float spread = n * static_cast<float>(radius_ * (radius_ + 1)) / 3;  // sum of k^2 over the window
    for (int u = 0; u < width_; ++u) {
      WindowFit& fit = fits_[index(u, v)];
      fit.misfit = -1;
      if (!whole_window(u, v)) continue;
      const float q0 = q_[index(u, v)];
      float sum = 0, sum_u = 0, sum_v = 0, squares = 0;
      for (int k = -radius_; k <= radius_; ++k) {
        const std::size_t i = index(u, v + k);
        const RowSums& row = rows_[i];
        const float step = q_[i] - q0, of_row = row.sum + side * step;
        sum += of_row;
        sum_u += row.moment;
        sum_v += static_cast<float>(k) * of_row;
        squares += row.squares + step * (2 * row.sum + side * step);
      }
      fit.su = sum_u / spread;
      fit.sv = sum_v / spread;
      fit.q = q0 + sum / n;
      const float residual = squares - sum * sum / n - (sum_u * sum_u + sum_v * sum_v) / spread;
      const float sigma = axial_sigma(index(u, v), 1 / q0) * q0 * q0;
      fit.misfit = std::max(0.0f, residual) / ((n - 3) * sigma * sigma);
    }
  }

  /// Slopes of the inverse depth per pixel; false without enough neighbours on the same surface.
  bool slopes(int u, int v, float& su, float& sv) const {
    const WindowFit& fit = fits_[index(u, v)];
    if (fit.misfit < 0) return slopes_by_parts(u, v, su, sv);
    su = fit.su;
    sv = fit.sv;
    return true;
  }

  bool slopes_by_parts(int u0, int v0, float& su, float& sv) const {
    const std::size_t centre = index(u0, v0);
    float n = 0, mu = 0, mv = 0, mq = 0, uu = 0, uv = 0, vv = 0, uq = 0, vq = 0;
    for (int v = std::max(0, v0 - radius_); v <= std::min(height_ - 1, v0 + radius_); ++v) {
      for (int u = std::max(0, u0 - radius_); u <= std::min(width_ - 1, u0 + radius_); ++u) {
        const std::size_t i = index(u, v);
        const float du = static_cast<float>(u - u0), dv = static_cast<float>(v - v0);
        if (q_[i] == 0 || !joined(centre, i, std::max(std::abs(du), std::abs(dv)))) continue;
        const float q = q_[i] - q_[centre];
        n += 1;
        mu += du;
        mv += dv;
        mq += q;
        uu += du * du;
        uv += du * dv;
        vv += dv * dv;
        uq += du * q;
        vq += dv * q;
      }
    }
    const float side = static_cast<float>(2 * radius_ + 1);
    if (n < std::max(6.0f, 0.4f * side * side)) return false;
    uu -= mu * mu / n;
    uv -= mu * mv / n;
    vv -= mv * mv / n;
    uq -= mu * mq / n;
    vq -= mv * mq / n;
    const float det = uu * vv - uv * uv;
    if (!(det > 0.05f * n * n)) return false;
    su = (uq * vv - vq * uv) / det;
    sv = (vq * uu - uq * uv) / det;
    return true;
  }

  /// Nothing in the 3 x 3 pixels around is nearer.
  float least_depth_around(int u0, int v0) const {
    float least = image_.depth[index(u0, v0)];
    for (int v = std::max(0, v0 - 1); v <= std::min(height_ - 1, v0 + 1); ++v) {
      for (int u = std::max(0, u0 - 1); u <= std::min(width_ - 1, u0 + 1); ++u) {
        const float z = image_.depth[index(u, v)];
        if (z > 0 && z < least) least = z;
      }
    }
    return least;
  }

  Fate plane_of(int u, int v) {
    const std::size_t i = index(u, v);
    out_.planes[i] = {};
    out_.bands[i] = {};
    if (shared_) out_.shares[i] = {};
    const float z = image_.depth[i];
    if (!(z > 0)) return Fate::missing;
    if (z < image_.camera.nearest) return Fate::out_of_range;
    PixelPlane& plane = out_.planes[i];
    const auto voxel = static_cast<float>(options_.voxel), truncation = static_cast<float>(options_.truncation);
    const float in_front = least_depth_around(u, v) - voxel;
    plane.free_depth = in_front - 4 * truncation;
    if (q_[i] == 0) return Fate::out_of_range;
    if (is_outlier(i, z)) return Fate::outlier;
    float su, sv;
    if (!slopes(u, v, su, sv)) return Fate::without_normal;
    // The plane m . X = 1: its inverse depth along the ray (x, y, 1) is m . (x, y, 1).
    const Vector3f ray((static_cast<float>(u) - static_cast<float>(image_.camera.cx)) / fx_,
                       (static_cast<float>(v) - static_cast<float>(image_.camera.cy)) / fy_, 1);
    const float q = q_[i];
    const Vector3f m(su * fx_, sv * fy_, q - su * fx_ * ray.x() - sv * fy_ * ray.y());
    const float length = m.norm(), ray_length = ray.norm();
    const float cosine = std::min(1.0f, q / (length * ray_length));
    if (!(cosine >= least_cosine_)) return Fate::too_slanted;
    float sigma = axial_sigma(i, z);
    if (uncertainty_.sigma.empty() && camera_.noise.slant > 0) {
      sigma = static_cast<float>(camera_.noise.sigma(z, std::acos(cosine)));
    }
    if (!(3 * sigma <= truncation)) return Fate::too_noisy;

    // How far the surface moves along n for a metre of depth; as lengths along the ray in the paper's form.
    const bool to_plane = options_.distance == SdfDistance::to_plane;
    const float along = to_plane ? q / length : ray_length;
    const Vector3f normal = -m / length;
    const Vector3f n = to_plane ? normal : Vector3f(0, 0, -ray_length);
    for (int k = 0; k < 3; ++k) plane.n[k] = n[k];
    plane.c = n.dot(z * ray);
    plane.reach = std::min(truncation * std::min(1.0f, along), kCellReach * voxel + kNoiseReach * sigma * along);
    // However uncertain a depth is, its surface counts as lying within the truncation.
    const float white =
        std::min(sigma * sigma * doubt(i, z, plane.reach / along), truncation * truncation) * along * along;
    const float common = pose_is_exact_ ? 0 : pose_variance(normal, z * ray) * (to_plane ? 1 : 1 / (cosine * cosine));
    plane.weight = 1 / (white + common);
    if (shared_) {
      const double systematic = std::hypot(camera_.systematic, camera_.systematic_scale * z);
      out_.shares[i] = {plane.weight * (white / (white + common)),
                        plane.weight * along * static_cast<float>(systematic)};
    }
    const float depth = plane.reach / along;
    plane.free_depth = std::min(in_front, z - depth);
    // Half a pixel beside the pixel's ray a slanted plane is that much nearer or farther.
    const float beside = 0.5f * slope_limit_ * z / fx_;
    out_.bands[i] = {z - depth - beside, z + depth + beside};
    return Fate::used;
  }

  /// Whether the neighbours, which are on one surface, say another depth; less than a voxel is an edge.
  bool is_outlier(std::size_t i, float z) const {
    if (!(options_.outlier_gate > 0)) return false;
    if (speckles_[i]) return true;
    if (fits_[i].misfit < 0) return false;
    // The fit holds the pixel itself, with a leverage of 1 / n.
    const float n = static_cast<float>((2 * radius_ + 1) * (2 * radius_ + 1));
    const float off = std::abs(q_[i] - fits_[i].q) * z * z * n / (n - 1);
    const float sigma = axial_sigma(i, z) * std::sqrt(n / (n - 1));
    return off > static_cast<float>(options_.outlier_gate) * sigma && off > static_cast<float>(options_.voxel);
  }

  /// What the variance is multiplied by where a plane of its own depth is not all there is to a pixel.
  float doubt(std::size_t i, float z, float depth) const {
    // Behind a rim lie faces that this frame does not see, and voxels near them are not as deep as it says. The fourth
    // power was chosen on rendered objects (tests/cpp/mapping/test_sdf_calibration.cpp).
    const float rim = std::min(1.0f, rim_[i] * z / (fx_ * depth));
    // Where the window is no plane, its normal is wrong by as much.
    const float misfit = std::max(1.0f, fits_[i].misfit / kGoodFit);
    return misfit / (rim * rim * rim * rim);
  }

  /// Variance of the plane's distance: displacement d and rotation r move the point p by d + r x p.
  float pose_variance(const Vector3f& normal, const Vector3f& p) const {
    const float x = p.y() * normal.z() - p.z() * normal.y(), y = p.z() * normal.x() - p.x() * normal.z(),
                z = p.x() * normal.y() - p.y() * normal.x();
    const float J[6] = {normal.x(), normal.y(), normal.z(), x, y, z};
    float out = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) out += J[i] * covariance_(i, j) * J[j];
    }
    return out;
  }

  void count() {
    IntegrationReport& report = out_.report = {};
    for (const Fate fate : fate_) {
      report.measured += fate != Fate::missing;
      report.used += fate == Fate::used;
      report.out_of_range += fate == Fate::out_of_range;
      report.too_noisy += fate == Fate::too_noisy;
      report.without_normal += fate == Fate::without_normal;
      report.too_slanted += fate == Fate::too_slanted;
      report.outliers += fate == Fate::outlier;
    }
  }

  const DepthImage& image_;
  const DepthCamera& camera_;
  const FrameUncertainty& uncertainty_;
  const SdfOptions& options_;
  const int width_, height_;
  const float fx_, fy_;
  float slope_limit_ = 0, least_cosine_ = 0;
  int radius_ = 2;
  Eigen::Matrix<float, 6, 6> covariance_;
  bool pose_is_exact_ = true, shared_ = false;
  std::vector<float>&q_, &rim_;
  std::vector<RowSums>& rows_;
  std::vector<WindowFit>& fits_;
  std::vector<std::uint8_t>& broken_;
  std::vector<int>& integral_;
  std::vector<Fate>& fate_;
  std::vector<std::uint8_t> speckles_;
  FramePlanes& out_;
};

}  // namespace

void frame_planes(const DepthImage& image, const DepthCamera& camera, const FrameUncertainty& uncertainty,
                  const SdfOptions& options, FramePlanes& out) {
  if (!out.scratch) out.scratch = std::make_shared<PlaneScratch>();
  PlaneFitter(image, camera, uncertainty, options, *out.scratch, out).fit();
}

}  // namespace mmgrasp::detail
