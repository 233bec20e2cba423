#pragma once

#include <embree3/rtcore.h>

#include <cmath>
#include <vector>

#include "mmgrasp/geometry/ray_caster.hpp"

namespace bench {

/// A mesh in Embree, as its users set it up for precision: robust traversal, a tree of high quality.
class EmbreeScene {
 public:
  explicit EmbreeScene(const mmgrasp::TriangleMesh& mesh) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3d& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    for (const auto& t : mesh.triangles)
      for (const int corner : t) *corners++ = static_cast<unsigned>(corner);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;

  void one_by_one(const std::vector<mmgrasp::Ray>& rays, std::vector<double>& distances) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCRayHit query{};
      set(query.ray, rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      distances[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? mmgrasp::RayHit().distance : query.ray.tfar;
    }
  }
  void in_eights(const std::vector<mmgrasp::Ray>& rays, std::vector<double>& distances) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    alignas(32) int valid[8];
    for (std::size_t i = 0; i < rays.size(); i += 8) {
      alignas(32) RTCRayHit8 query;
      for (std::size_t j = 0; j < 8; ++j) {
        RTCRay ray{};
        const bool used = i + j < rays.size();
        set(ray, rays[used ? i + j : i]);
        valid[j] = used ? -1 : 0;
        query.ray.org_x[j] = ray.org_x;
        query.ray.org_y[j] = ray.org_y;
        query.ray.org_z[j] = ray.org_z;
        query.ray.dir_x[j] = ray.dir_x;
        query.ray.dir_y[j] = ray.dir_y;
        query.ray.dir_z[j] = ray.dir_z;
        query.ray.tnear[j] = ray.tnear;
        query.ray.tfar[j] = ray.tfar;
        query.ray.time[j] = 0;
        query.ray.mask[j] = ray.mask;
        query.ray.flags[j] = 0;
        query.hit.geomID[j] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][j] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid, scene_, &context, &query);
      for (std::size_t j = 0; j < 8 && i + j < rays.size(); ++j)
        distances[i + j] =
            query.hit.geomID[j] == RTC_INVALID_GEOMETRY_ID ? mmgrasp::RayHit().distance : query.ray.tfar[j];
    }
  }
  std::size_t any(const std::vector<mmgrasp::Ray>& rays) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::size_t hits = 0;
    for (const mmgrasp::Ray& each : rays) {
      RTCRay ray{};
      set(ray, each);
      rtcOccluded1(scene_, &context, &ray);
      hits += ray.tfar < 0;
    }
    return hits;
  }

 private:
  static void set(RTCRay& ray, const mmgrasp::Ray& from) {
    ray.org_x = static_cast<float>(from.origin.x());
    ray.org_y = static_cast<float>(from.origin.y());
    ray.org_z = static_cast<float>(from.origin.z());
    ray.dir_x = static_cast<float>(from.direction.x());
    ray.dir_y = static_cast<float>(from.direction.y());
    ray.dir_z = static_cast<float>(from.direction.z());
    ray.tnear = 0;
    ray.tfar = static_cast<float>(from.farthest);
    ray.mask = ~0u;
  }

  RTCDevice device_ = rtcNewDevice("threads=1");
  RTCScene scene_ = rtcNewScene(device_);
};

}  // namespace bench
