#include "grasp/sampling/far_face.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

FarFace::FarFace(const std::vector<LinkShape>& body) {
  std::vector<Eigen::Vector3d> vertices;
  for (const LinkShape& shape : body) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape.shape)) {
      for (const Eigen::Vector3d& vertex : mesh->mesh->vertices) vertices.push_back(shape.T_link_shape * vertex);
    } else {
      primitives_.push_back(shape);
    }
  }
  vertices_.resize(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices_.col(static_cast<Eigen::Index>(i)) = vertices[i];
}

double FarFace::operator()(const Eigen::Vector3d& direction) const {
  double reach = vertices_.cols() > 0 ? (direction.transpose() * vertices_).maxCoeff() : -kInfinity;
  Pose T = Pose::Identity();  // turns the direction into x
  T.linear() = Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const LinkShape& shape : primitives_)
    reach = std::max(reach, shape_bounds(shape.shape, T * shape.T_link_shape).max().x());
  return reach;
}

}  // namespace mmgrasp::detail
