#include "mapping/top_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
constexpr double kTail = 0.01;            // share of points left out at each end
constexpr double kWhole = 0.85;           // fill from which a face counts as seen whole
constexpr double kTrust = 5 * kPi / 180;  // the moments refine the angle by at most this

/// Points sorted along a direction, for weighted quantiles.
class Profile {
 public:
  Profile(const FacePoints& face, const Vector2d& direction) {
    const std::size_t n = face.points.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = direction.dot(face.points[i]);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    double sum = 0;
    for (const std::size_t i : order) {
      sum += face.weights[i];
      x_.push_back(x[i]);
      reached_.push_back(sum - face.weights[i] / 2);
    }
    total_ = sum;
  }

  double quantile(double share) const {
    const double wanted = share * total_;
    const auto it = std::lower_bound(reached_.begin(), reached_.end(), wanted);
    if (it == reached_.begin()) return x_.front();
    if (it == reached_.end()) return x_.back();
    const std::size_t i = it - reached_.begin();
    const double s = (wanted - reached_[i - 1]) / (reached_[i] - reached_[i - 1]);
    return x_[i - 1] + s * (x_[i] - x_[i - 1]);
  }
  double extent() const { return quantile(1 - kTail) - quantile(kTail); }

 private:
  std::vector<double> x_, reached_;
  double total_ = 0;
};

Vector2d direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

double trimmed_area(const FacePoints& face, double angle) {
  return Profile(face, direction(angle)).extent() * Profile(face, direction(angle + kPi / 2)).extent();
}

double least_area_angle(const FacePoints& face) {
  FacePoints some;  // enough of them for a first angle
  const std::size_t step = std::max<std::size_t>(1, face.points.size() / 500);
  for (std::size_t i = 0; i < face.points.size(); i += step) {
    some.points.push_back(face.points[i]);
    some.weights.push_back(face.weights[i]);
  }
  double best = 0, best_area = trimmed_area(some, 0);
  for (int degree = 1; degree < 90; ++degree) {
    const double area = trimmed_area(some, degree * kPi / 180);
    if (area < best_area) {
      best_area = area;
      best = degree * kPi / 180;
    }
  }
  return best;
}

/// Angle of a filled rectangle's sides from its second moments, or for a nearly square one from its fourth: noise that
/// is alike in all directions cancels in both.
double moment_angle(const FacePoints& face, const Rectangle& rough) {
  std::complex<double> second = 0, fourth = 0;
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    const Vector2d p = face.points[i] - rough.centre;
    const Vector2d along = direction(rough.angle), across = direction(rough.angle + kPi / 2);
    const bool stray =
        std::abs(along.dot(p)) > 0.55 * rough.size.x() || std::abs(across.dot(p)) > 0.55 * rough.size.y();
    if (stray) continue;
    const std::complex<double> z(p.x(), p.y()), z2 = z * z;
    second += face.weights[i] * z2;
    fourth += face.weights[i] * z2 * z2;
  }
  const double ratio = rough.size.maxCoeff() / std::max(rough.size.minCoeff(), 1e-9);
  return ratio > 1.3 ? std::arg(second) / 2 : std::arg(-fourth) / 4;
}

/// The angle's turn by a multiple of a quarter that lies nearest to another one.
double nearest_quarter(double angle, double to) {
  return angle + std::round((to - angle) / (kPi / 2)) * kPi / 2;
}

/// Rectangle at a given angle: by quartiles when the face was seen whole, else by its extent.
Rectangle at_angle(const FacePoints& face, double angle, bool whole) {
  Rectangle out;
  out.angle = angle;
  const double low = whole ? 0.25 : kTail;
  for (int k = 0; k < 2; ++k) {
    const Profile profile(face, direction(angle + k * kPi / 2));
    const double a = profile.quantile(low), b = profile.quantile(1 - low);
    out.size[k] = (b - a) / (1 - 2 * low);
    out.centre += (a + b) / 2 * direction(angle + k * kPi / 2);
  }
  return out;
}

double filled_share(const FacePoints& face, const Rectangle& box, double cell) {
  const int nx = std::max(1, static_cast<int>(box.size.x() / cell)),
            ny = std::max(1, static_cast<int>(box.size.y() / cell));
  if (static_cast<double>(nx) * ny > 1e7) return 0;
  std::vector<char> seen(static_cast<std::size_t>(nx) * ny, 0);
  for (const Vector2d& point : face.points) {
    const Vector2d p = point - box.centre;
    const int ix = static_cast<int>(std::floor((direction(box.angle).dot(p) / box.size.x() + 0.5) * nx));
    const int iy = static_cast<int>(std::floor((direction(box.angle + kPi / 2).dot(p) / box.size.y() + 0.5) * ny));
    if (ix >= 0 && ix < nx && iy >= 0 && iy < ny) seen[static_cast<std::size_t>(iy) * nx + ix] = 1;
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), 1)) / seen.size();
}

}  // namespace

Rectangle fit_rectangle(const FacePoints& face, double cell) {
  Rectangle box = at_angle(face, least_area_angle(face), false);
  box.fill = filled_share(face, box, cell);
  if (box.fill < kWhole) return box;
  for (int round = 0; round < 2; ++round) {
    const double angle = nearest_quarter(moment_angle(face, box), box.angle);
    const double fill = box.fill;
    box = at_angle(face, std::abs(angle - box.angle) < kTrust ? angle : box.angle, true);
    box.fill = fill;
  }
  return box;
}

std::vector<Vector2d> hull_of(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= start + 2) {
        const Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2], b = p - hull[hull.size() - 2];
        if (a.x() * b.y() - a.y() * b.x() > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

bool inside_hull(const std::vector<Vector2d>& hull, const Vector2d& point) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d a = hull[(i + 1) % hull.size()] - hull[i], b = point - hull[i];
    if (a.x() * b.y() - a.y() * b.x() < 0) return false;
  }
  return hull.size() >= 3;
}

}  // namespace mmgrasp::detail
