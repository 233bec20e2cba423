#include "mmgrasp/plan/roadmap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "mmgrasp/core/detail/ball_volume.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp {
namespace {

constexpr int kLeafSize = 12;
constexpr double kConnectedShare = 0.99;  // Share of all vertices in the largest component.

}  // namespace

void RoadmapOptions::check() const {
  require(vertices >= 2 && vertices <= 10'000'000, "vertices", vertices, "must be in [2, 10000000]");
  require_not_negative(gamma, "gamma");
  require_count(neighbours, "neighbours", 0, 1'000'000);
}

bool Roadmap::Data::draw(detail::CancelCheck& cancel) {
  const Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    require(std::isfinite(upper[i] - lower[i]), "group: width of '" + group.names()[i] + "'", upper[i] - lower[i],
            "must be finite to draw a roadmap from");
  }
  vertices.resize(lower.size(), options.vertices);
  constexpr Eigen::Index kBlock = 1024;
  const Eigen::Index count = vertices.cols();
  const auto draw_block = [&](std::size_t block, int) {
    cancel.stopped();
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kBlock;
    // Each vertex has its own random stream, so that vertex i does not depend on their number.
    for (Eigen::Index i = first; i < std::min(first + kBlock, count); ++i)
      vertices.col(i) = Rng(options.seed, static_cast<std::uint64_t>(i)).uniform(lower, upper);
  };
  return parallel_for((count + kBlock - 1) / kBlock, 0, draw_block, cancel.monitor(), "roadmap");
}

bool Roadmap::Data::index(detail::CancelCheck& cancel) {
  if (metric.weighted()) coordinates = metric.weights().asDiagonal() * vertices;
  cloud =
      std::make_unique<detail::ColumnCloud>(detail::ColumnCloud{metric.weighted() ? coordinates : vertices, &cancel});
  try {
    tree = std::make_unique<detail::ColumnTree>(static_cast<int>(vertices.rows()), *cloud,
                                                nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  } catch (const detail::ColumnCloud::Stopped&) {
    return false;
  }
  cloud->cancel = nullptr;
  return true;
}

double Roadmap::Data::radius() const {
  const double n = static_cast<double>(vertices.cols()), d = static_cast<double>(vertices.rows());
  return options.gamma * metric.unit() * std::pow(std::log(n) / n, 1 / d);
}

void Roadmap::Data::near_around(const double* q, int neighbours, std::vector<int>& out) const {
  std::vector<double> image(vertices.rows());
  metric.to_coordinates(q, image.data(), static_cast<int>(vertices.rows()));
  const std::vector<int>& wrapping = metric.wrapping();
  const std::size_t wanted = std::min<Eigen::Index>(neighbours, vertices.cols());
  const double r = radius();
  std::vector<std::pair<double, int>> found;  // Squared distance and vertex; several times where images share one.
  std::vector<int> hits(wanted);
  std::vector<double> squared(wanted);
  std::vector<std::pair<int, double>> within;
  nanoflann::SearchParams params;
  params.sorted = false;
  const auto ask = [&] {
    if (wanted > 0) {
      const std::size_t count = tree->knnSearch(image.data(), wanted, hits.data(), squared.data());
      for (std::size_t i = 0; i < count; ++i) found.emplace_back(squared[i], hits[i]);
    } else {
      tree->radiusSearch(image.data(), r * r, within, params);
      for (const auto& hit : within) found.emplace_back(hit.second, hit.first);
    }
  };
  // `off`: squared distance of the image to the box that holds all vertices.
  const std::function<void(std::size_t, double)> ask_images = [&](std::size_t k, double off) {
    if (k == wrapping.size()) return ask();
    ask_images(k + 1, off);
    double& value = image[wrapping[k]];
    const double own = value, turn = metric.turn(wrapping[k]), beyond = 0.5 * turn - std::abs(own);
    off += beyond * beyond;
    if (wanted == 0 && off >= r * r) return;
    value += own > 0 ? -turn : turn;
    ask_images(k + 1, off);
    value = own;
  };
  ask_images(0, 0);
  // Each vertex once, at its least distance.
  const auto by_vertex = [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  };
  std::sort(found.begin(), found.end(), by_vertex);
  const auto same = [](const auto& a, const auto& b) { return a.second == b.second; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  if (wanted > 0 && found.size() > wanted) {
    std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(wanted), found.end());
    found.resize(wanted);
  }
  for (const auto& hit : found) out.push_back(hit.second);
  std::sort(out.begin(), out.end());
}

int Roadmap::Data::neighbours() const {
  if (options.neighbours > 0 || options.gamma > 0) return options.neighbours;
  const double d = static_cast<double>(vertices.rows()), n = static_cast<double>(vertices.cols());
  return static_cast<int>(std::ceil(std::exp(1.0) * (1 + 1 / d) * std::log(n)));
}

void Roadmap::Data::near(const double* q, int neighbours, std::vector<int>& out) const {
  out.clear();
  if (!metric.plain()) return near_around(q, neighbours, out);
  if (neighbours > 0) {
    const std::size_t wanted = std::min<Eigen::Index>(neighbours, vertices.cols());
    out.resize(wanted);
    std::vector<double> squared(wanted);
    out.resize(tree->knnSearch(q, wanted, out.data(), squared.data()));
  } else {
    const double r = radius();
    std::vector<std::pair<int, double>> found;
    nanoflann::SearchParams params;
    params.sorted = false;
    tree->radiusSearch(q, r * r, found, params);
    for (const auto& hit : found) out.push_back(hit.first);
  }
  std::sort(out.begin(), out.end());
}

bool Roadmap::Data::join(detail::CancelCheck& cancel, int threads) {
  const std::size_t count = vertices.cols();
  // With a fixed number of neighbours the vertex itself is its nearest one.
  std::vector<std::vector<int>> joined(count);
  const int wanted = neighbours() > 0 ? neighbours() + 1 : 0;
  const auto join_one = [&](std::size_t v, int) {
    cancel.stopped();
    near(vertices.col(static_cast<Eigen::Index>(v)).data(), wanted, joined[v]);
  };
  if (!parallel_for(count, threads, join_one, cancel.monitor(), "roadmap")) return false;
  // An edge found from its end with the larger number only is added to the other end's list, which then holds all.
  for (std::size_t v = 0; v < count; ++v) {
    if (cancel.stopped()) return false;
    for (const int u : joined[v])
      if (static_cast<std::size_t>(u) < v) joined[u].push_back(static_cast<int>(v));
  }
  ends.clear();
  for (std::size_t v = 0; v < count; ++v) {
    if (cancel.stopped()) return false;
    std::vector<int>& others = joined[v];
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const int u : others)
      if (static_cast<std::size_t>(u) > v) ends.emplace_back(static_cast<int>(v), u);
  }
  return make_arcs(cancel);
}

bool Roadmap::Data::make_arcs(detail::CancelCheck& cancel) {
  const std::size_t count = vertices.cols();
  first.assign(count + 1, 0);
  for (const auto& [a, b] : ends) {
    ++first[a + 1];
    ++first[b + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  arcs.resize(2 * ends.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (e % 256 == 0 && cancel.stopped()) return false;
    const auto [a, b] = ends[e];
    const double length = metric.distance(vertices.col(a), vertices.col(b));
    arcs[next[a]++] = {b, static_cast<int>(e), length};
    arcs[next[b]++] = {a, static_cast<int>(e), length};
  }
  count_components();
  return true;
}

void Roadmap::Data::count_components() {
  const std::size_t count = vertices.cols();
  components = largest_component = 0;
  std::vector<char> seen(count, 0);
  std::vector<std::size_t> stack;
  for (std::size_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    ++components;
    int members = 0;
    stack.assign(1, start);
    seen[start] = 1;
    while (!stack.empty()) {
      const std::size_t v = stack.back();
      stack.pop_back();
      ++members;
      for (int arc = first[v]; arc < first[v + 1]; ++arc) {
        const std::size_t to = arcs[arc].to;
        if (seen[to]) continue;
        seen[to] = 1;
        stack.push_back(to);
      }
    }
    largest_component = std::max(largest_component, members);
  }
}

Roadmap::Roadmap(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

Roadmap detail::build_roadmap(const JointGroup& group, const RoadmapOptions& options, const Monitor& monitor,
                              const std::function<bool()>& over) {
  options.check();
  CancelCheck cancel(monitor, over);
  auto data = std::make_shared<Roadmap::Data>(group, options);
  if (data->draw(cancel) && data->index(cancel) && data->join(cancel, 0)) return Roadmap(data);
  data = std::make_shared<Roadmap::Data>(group, options);
  data->vertices.resize(group.size(), 0);
  CancelCheck never;
  data->make_arcs(never);
  return Roadmap(data);
}

Roadmap detail::roadmap_over(const JointGroup& group, int neighbours, Eigen::MatrixXd vertices,
                             const JointWeights& weights) {
  RoadmapOptions options;
  options.joint_weights = weights;
  options.vertices = static_cast<int>(vertices.cols());
  options.neighbours = neighbours;
  auto data = std::make_shared<Roadmap::Data>(group, options);
  data->vertices = std::move(vertices);
  CancelCheck never;
  data->index(never);
  data->join(never, 1);
  return Roadmap(data);
}

Roadmap Roadmap::build(const JointGroup& group, const RoadmapOptions& options, const Monitor& monitor) {
  return detail::build_roadmap(group, options, monitor, [&] { return monitor.stopped(); });
}

const JointGroup& Roadmap::group() const {
  return data_->group;
}
const RoadmapOptions& Roadmap::options() const {
  return data_->options;
}
int Roadmap::size() const {
  return static_cast<int>(data_->vertices.cols());
}
int Roadmap::edge_count() const {
  return static_cast<int>(data_->ends.size());
}
const Eigen::MatrixXd& Roadmap::vertices() const {
  return data_->vertices;
}
const Roadmap::Arc* Roadmap::begin(int vertex) const {
  return data_->arcs.data() + data_->first[vertex];
}
const Roadmap::Arc* Roadmap::end(int vertex) const {
  return data_->arcs.data() + data_->first[vertex + 1];
}
std::pair<int, int> Roadmap::ends(int edge) const {
  return data_->ends[edge];
}

void Roadmap::near(const Eigen::VectorXd& q, std::vector<int>& out) const {
  data_->group.check_configuration(q, "q");
  out.clear();
  if (size() > 0) data_->near(q.data(), data_->neighbours(), out);
}

double Roadmap::radius() const {
  return size() == 0 || data_->neighbours() > 0 ? 0 : data_->radius();
}

RoadmapStatistics Roadmap::statistics() const {
  RoadmapStatistics out;
  const auto d = static_cast<double>(data_->group.size());
  out.volume = (data_->group.sample_upper() - data_->group.sample_lower()).prod();
  if (data_->metric.weighted()) out.volume *= data_->metric.weights().prod();
  out.gamma_star = 2 * std::pow(1 + 1 / d, 1 / d) *
                   std::pow(out.volume / detail::unit_ball_volume(data_->group.size()), 1 / d) / data_->metric.unit();
  if (size() == 0) return out;
  out.mean_degree = 2.0 * edge_count() / size();
  out.components = data_->components;
  out.largest_component = data_->largest_component;
  out.neighbours = data_->neighbours();
  if (out.neighbours == 0) out.radius = data_->radius();
  if (out.neighbours > 0)
    for (const Arc& arc : data_->arcs) out.radius = std::max(out.radius, arc.length);
  return out;
}

std::string Roadmap::warning() const {
  if (data_->largest_component >= kConnectedShare * size()) return {};
  return "the roadmap is in " + std::to_string(data_->components) + " pieces, the largest of " +
         std::to_string(data_->largest_component) + " of " + std::to_string(size()) +
         " vertices: between pieces no path is found; set gamma = 0 and neighbours = 0 (the defaults), or more "
         "neighbours";
}

}  // namespace mmgrasp
