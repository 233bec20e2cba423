// Rays against a mesh of about 16,000 faces, one thread: mmgrasp's ray caster and, where it was found, Embree. Rays
// come from a sphere around the mesh, and from inside it, in no order. Every answer is compared with a test of every
// triangle in extended precision.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "report.hpp"
#ifdef MMGRASP_WITH_EMBREE
#include "embree_baseline.hpp"
#endif

namespace {

using Eigen::Vector3d;
using mmgrasp::Ray;
using mmgrasp::RayHit;

std::shared_ptr<const mmgrasp::TriangleMesh> sixteen_thousand_faces() {
  return mmgrasp::load_mesh(std::string(MMGRASP_SHARED_DATA) +
                            "/meshes/ycb/YcbMustardBottle/textured_simple_reoriented.obj");
}

struct Case {
  const char* name;
  std::vector<Ray> rays;
};

std::vector<Case> cases(const mmgrasp::TriangleMesh& mesh, int count) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : mesh.vertices) box.extend(v);
  mmgrasp::Rng rng(1);
  const auto in_box = [&] {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = rng.uniform(box.min()[k], box.max()[k]);
    return p;
  };
  const auto on_sphere = [&]() -> Vector3d { return Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized(); };
  Case outside{"mustard bottle, from outside", {}}, inside{"mustard bottle, from its middle", {}};
  for (int i = 0; i < count; ++i) {
    const Vector3d eye = box.center() + 1.5 * box.diagonal().norm() * on_sphere();
    outside.rays.push_back({eye, (in_box() - eye).normalized()});
    inside.rays.push_back({box.center() + 0.2 * (in_box() - box.center()), on_sphere()});
  }
  return {outside, inside};
}

// The first hit by every triangle, in long double.
double brute_force(const mmgrasp::TriangleMesh& mesh, const Ray& ray) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long o = ray.origin.cast<long double>(), d = ray.direction.cast<long double>();
  long double best = mmgrasp::RayHit().distance;
  for (const auto& t : mesh.triangles) {
    const Long a = mesh.vertices[t[0]].cast<long double>();
    const Long ab = mesh.vertices[t[1]].cast<long double>() - a, ac = mesh.vertices[t[2]].cast<long double>() - a;
    const Long p = d.cross(ac);
    const long double det = ab.dot(p);
    if (det == 0) continue;
    const Long s = o - a, q = s.cross(ab);
    const long double u = s.dot(p) / det, v = d.dot(q) / det, at = ac.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && at >= 0 && at < best) best = at;
  }
  return static_cast<double>(best);
}

struct Accuracy {
  int hits = 0, differ = 0;  // differ: one meets the mesh, the other does not
  double largest = 0;        // difference of the distances [m] where both do
};

Accuracy accuracy(const std::vector<double>& truth, const std::vector<double>& distances) {
  Accuracy out;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    out.hits += std::isfinite(truth[i]);
    if (std::isfinite(truth[i]) != std::isfinite(distances[i]))
      ++out.differ;
    else if (std::isfinite(truth[i]))
      out.largest = std::max(out.largest, std::abs(truth[i] - distances[i]));
  }
  return out;
}

// Median over `rounds` of the processor's time of one call of work() [s]: a rate per core, whoever else is at work.
template <class Work>
double median_processor_time(int rounds, const Work& work) {
  work();
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) {
    const double start = bench::processor_seconds();
    work();
    times.push_back(bench::processor_seconds() - start);
  }
  std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
  return times[rounds / 2];
}

void report(const char* on, const char* who, double rays_per_second, const Accuracy& accuracy, std::size_t checked,
            const char* settings) {
  char more[320];
  std::snprintf(more, sizeof more,
                "\"hits\": %.3f, \"rays checked\": %zu, \"hit or miss wrong\": %d, \"largest error m\": %.2g, "
                "\"million rays per s\": %.2f",
                static_cast<double>(accuracy.hits) / static_cast<double>(checked), checked, accuracy.differ,
                accuracy.largest, 1e-6 * rays_per_second);
  bench::print({"rays", on, who, "us", 1e6 / rays_per_second, more, settings});
}

}  // namespace

int main() {
  constexpr int kRays = 1000000, kRounds = 7;
  constexpr std::size_t kChecked = 20000;
  const auto mesh = sixteen_thousand_faces();
  double start = bench::now();
  const mmgrasp::RayCaster caster(*mesh);
  const double build = bench::now() - start;
#ifdef MMGRASP_WITH_EMBREE
  start = bench::now();
  const bench::EmbreeScene embree(*mesh);
  const double embree_build = bench::now() - start;
  std::fprintf(stderr, "%zu faces; build: ours %.1f ms, Embree %.1f ms\n", mesh->triangles.size(), 1e3 * build,
               1e3 * embree_build);
#else
  std::fprintf(stderr, "%zu faces; build %.1f ms\n", mesh->triangles.size(), 1e3 * build);
#endif
  for (const Case& each : cases(*mesh, kRays)) {
    std::vector<double> truth, distances(kRays);
    for (std::size_t i = 0; i < kChecked; ++i) truth.push_back(brute_force(*mesh, each.rays[i]));

    double seconds = median_processor_time(kRounds, [&] {
      for (int i = 0; i < kRays; ++i) distances[i] = caster.closest_hit(each.rays[i]).distance;
    });
    report(each.name, "mmgrasp, one ray", kRays / seconds, accuracy(truth, distances), kChecked,
           "closest_hit with normal");
    std::vector<RayHit> all;
    seconds = median_processor_time(kRounds, [&] {
      caster.closest_hits(each.rays, all);
      for (int i = 0; i < kRays; ++i) distances[i] = all[i].distance;
    });
    report(each.name, "mmgrasp, batch", kRays / seconds, accuracy(truth, distances), kChecked,
           "closest_hits with normals");
    std::size_t any = 0;
    seconds = median_processor_time(kRounds, [&] {
      for (const Ray& ray : each.rays) any += caster.any_hit(ray);
    });
    bench::print({"rays, any hit", each.name, "mmgrasp, one ray", "us", 1e6 * seconds / kRays, "", "any_hit"});
    seconds = median_processor_time(kRounds, [&] { any += caster.any_hits(each.rays).back(); });
    bench::print({"rays, any hit", each.name, "mmgrasp, batch", "us", 1e6 * seconds / kRays, "", "any_hits"});
#ifdef MMGRASP_WITH_EMBREE
    seconds = median_processor_time(kRounds, [&] { embree.one_by_one(each.rays, distances); });
    report(each.name, "Embree, one ray", kRays / seconds, accuracy(truth, distances), kChecked,
           "rtcIntersect1, robust, high quality");
    seconds = median_processor_time(kRounds, [&] { embree.in_eights(each.rays, distances); });
    report(each.name, "Embree, eight rays", kRays / seconds, accuracy(truth, distances), kChecked,
           "rtcIntersect8, robust, high quality");
    seconds = median_processor_time(kRounds, [&] { any += embree.any(each.rays); });
    bench::print({"rays, any hit", each.name, "Embree, one ray", "us", 1e6 * seconds / kRays, "", "rtcOccluded1"});
#endif
    if (any == 1) return 1;  // keeps the loops
  }
  return 0;
}
