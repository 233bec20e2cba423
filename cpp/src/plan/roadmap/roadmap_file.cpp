// Roadmap::save and Roadmap::load. A file holds vertices and edges as they are in memory: magic, key, sizes, numbers,
// weights (none: all 1),
// checksum.
#include <cstring>
#include <functional>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/hash.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp {
namespace {

constexpr char kMagic[] = "mmgrasp roadmap 2\n";

struct Header {
  std::uint64_t key;
  std::int64_t joints, vertices, edges;
  double gamma;
  std::int64_t neighbours, seed, weights;
};

void append(std::string& out, const void* bytes, std::size_t size) {
  out.append(static_cast<const char*>(bytes), size);
}

}  // namespace

std::uint64_t detail::kinematics_key(const JointGroup& group) {
  Hasher hasher;
  for (const Joint& joint : group.robot().joints()) {
    hasher.add(joint.name).add(joint.type).add(joint.parent_link).add(joint.child_link);
    hasher.add(Eigen::MatrixXd(joint.T_parent_joint.matrix())).add(Eigen::MatrixXd(joint.axis));
    hasher.add(joint.mimic_joint).add(joint.mimic_multiplier).add(joint.mimic_offset);
  }
  for (const std::string& name : group.names()) hasher.add(name);
  hasher.add(Eigen::MatrixXd(group.sample_lower())).add(Eigen::MatrixXd(group.sample_upper()));
  // Roadmaps of such groups once had no edges across the seam of an angle: their files are refused.
  if (detail::JointMetric(group.wraps()).any()) hasher.add(std::string("edges go the short way round"));
  return hasher.value();
}

void Roadmap::save(const std::string& path) const {
  const Data& data = *data_;
  const Header header{detail::kinematics_key(data.group),
                      data.vertices.rows(),
                      data.vertices.cols(),
                      edge_count(),
                      data.options.gamma,
                      data.options.neighbours,
                      data.options.seed,
                      data.metric.weights().size()};
  std::string out(kMagic);
  append(out, &header, sizeof header);
  append(out, data.vertices.data(), sizeof(double) * data.vertices.size());
  for (const auto& [a, b] : data.ends) {
    const std::int32_t pair[2] = {a, b};
    append(out, pair, sizeof pair);
  }
  append(out, data.metric.weights().data(), sizeof(double) * data.metric.weights().size());
  const std::uint64_t checksum = Hasher().add(out).value();
  append(out, &checksum, sizeof checksum);
  detail::write_file(path, "roadmap", {out});
}

Roadmap Roadmap::load(const std::string& path, const JointGroup& group) {
  const std::string content = detail::file_content(path, "roadmap");
  constexpr std::size_t kStart = sizeof kMagic - 1;
  if (content.compare(0, kStart, kMagic) != 0) throw IoError(path + ": is no roadmap of this version");
  if (content.size() < kStart + sizeof(Header) + sizeof(std::uint64_t)) throw IoError(path + ": is cut off");
  const std::size_t body = content.size() - sizeof(std::uint64_t);
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, content.data() + body, sizeof checksum);
  if (Hasher().add(static_cast<std::int64_t>(body)).add(content.data(), body).value() != checksum)
    throw IoError(path + ": is damaged or cut off: its checksum does not match");
  Header header{};
  std::memcpy(&header, content.data() + kStart, sizeof header);
  if (header.key != detail::kinematics_key(group)) {
    throw IoError(path + ": was made for another robot, other joints or other limits than group '" + group.name() +
                  "' of '" + group.robot().name() + "'");
  }
  const std::size_t vertex_bytes = sizeof(double) * (header.joints * header.vertices);
  const std::size_t edge_bytes = 2 * sizeof(std::int32_t) * header.edges;
  const std::size_t weight_bytes = sizeof(double) * header.weights;
  if (header.joints != group.size() || header.vertices < 0 || header.edges < 0 ||
      (header.weights != 0 && header.weights != header.joints) ||
      body != kStart + sizeof header + vertex_bytes + edge_bytes + weight_bytes) {
    throw IoError(path + ": is damaged: sizes do not fit");
  }
  RoadmapOptions options;
  options.vertices = static_cast<int>(header.vertices);
  options.gamma = header.gamma;
  options.neighbours = static_cast<int>(header.neighbours);
  options.seed = static_cast<unsigned>(header.seed);
  options.joint_weights.values.resize(header.weights);
  std::memcpy(options.joint_weights.values.data(), content.data() + body - weight_bytes, weight_bytes);
  auto data = std::make_shared<Data>(group, options);
  const char* at = content.data() + kStart + sizeof header;
  data->vertices.resize(header.joints, header.vertices);
  std::memcpy(data->vertices.data(), at, vertex_bytes);
  at += vertex_bytes;
  data->ends.reserve(header.edges);
  for (std::int64_t e = 0; e < header.edges; ++e, at += 2 * sizeof(std::int32_t)) {
    std::int32_t pair[2];
    std::memcpy(pair, at, sizeof pair);
    if (pair[0] < 0 || pair[0] >= pair[1] || pair[1] >= header.vertices) throw IoError(path + ": is damaged: bad edge");
    data->ends.emplace_back(pair[0], pair[1]);
  }
  const CancelToken* const token = detail::interruption_token();
  const std::function<bool()> over = [token] { return token && token->stopped(); };
  detail::CancelCheck interrupted({}, over);
  const bool whole = (data->vertices.cols() == 0 || data->index(interrupted)) && data->make_arcs(interrupted);
  if (!whole) throw detail::Interrupted();
  return Roadmap(data);
}

}  // namespace mmgrasp
