#include "mmgrasp/plan/roadmap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/detail/ball_volume.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp {
namespace {

constexpr int kLeafSize = 12;

}  // namespace

void RoadmapOptions::check() const {
  require(vertices >= 2 && vertices <= 10'000'000, "vertices", vertices, "must be in [2, 10000000]");
  require(std::isfinite(gamma) && gamma > 0, "gamma", gamma, "must be finite and > 0");
  require(neighbours >= 0, "neighbours", neighbours, "must be >= 0");
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
  return parallel_for(static_cast<std::size_t>((count + kBlock - 1) / kBlock), 0, draw_block, cancel.monitor(),
                      "roadmap");
}

bool Roadmap::Data::index(detail::CancelCheck& cancel) {
  cloud = std::make_unique<detail::ColumnCloud>(detail::ColumnCloud{vertices, &cancel});
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
  return options.gamma * std::pow(std::log(n) / n, 1 / d);
}

void Roadmap::Data::near(const double* q, int neighbours, std::vector<int>& out) const {
  out.clear();
  if (neighbours > 0) {
    const auto wanted = static_cast<std::size_t>(std::min<Eigen::Index>(neighbours, vertices.cols()));
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
  const auto count = static_cast<std::size_t>(vertices.cols());
  // With a fixed number of neighbours the vertex itself is its nearest one.
  std::vector<std::vector<int>> joined(count);
  const int wanted = options.neighbours > 0 ? options.neighbours + 1 : 0;
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
  const auto count = static_cast<std::size_t>(vertices.cols());
  first.assign(count + 1, 0);
  for (const auto& [a, b] : ends) {
    ++first[static_cast<std::size_t>(a) + 1];
    ++first[static_cast<std::size_t>(b) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  arcs.resize(2 * ends.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (e % 256 == 0 && cancel.stopped()) return false;
    const auto [a, b] = ends[e];
    const double length = (vertices.col(a) - vertices.col(b)).norm();
    arcs[next[a]++] = {b, static_cast<int>(e), length};
    arcs[next[b]++] = {a, static_cast<int>(e), length};
  }
  return true;
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

Roadmap detail::roadmap_over(const JointGroup& group, int neighbours, Eigen::MatrixXd vertices) {
  RoadmapOptions options;
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
  return data_->arcs.data() + data_->first[static_cast<std::size_t>(vertex) + 1];
}
std::pair<int, int> Roadmap::ends(int edge) const {
  return data_->ends[edge];
}

void Roadmap::near(const Eigen::VectorXd& q, std::vector<int>& out) const {
  data_->group.check_configuration(q, "q");
  out.clear();
  if (size() > 0) data_->near(q.data(), options().neighbours, out);
}

double Roadmap::radius() const {
  return options().neighbours > 0 || size() == 0 ? 0 : data_->radius();
}

RoadmapStatistics Roadmap::statistics() const {
  RoadmapStatistics out;
  const auto d = static_cast<double>(data_->group.size());
  out.volume = (data_->group.sample_upper() - data_->group.sample_lower()).prod();
  out.gamma_star =
      2 * std::pow(1 + 1 / d, 1 / d) * std::pow(out.volume / detail::unit_ball_volume(data_->group.size()), 1 / d);
  if (size() == 0) return out;
  out.mean_degree = 2.0 * edge_count() / size();
  out.radius = data_->radius();
  if (options().neighbours > 0) {
    out.radius = 0;
    for (const Arc& arc : data_->arcs) out.radius = std::max(out.radius, arc.length);
  }
  std::vector<char> seen(static_cast<std::size_t>(size()), 0);
  std::vector<int> stack;
  for (int start = 0; start < size(); ++start) {
    if (seen[start]) continue;
    ++out.components;
    int members = 0;
    stack.assign(1, start);
    seen[start] = 1;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      ++members;
      for (const Arc* arc = begin(v); arc != end(v); ++arc) {
        if (seen[arc->to]) continue;
        seen[arc->to] = 1;
        stack.push_back(arc->to);
      }
    }
    out.largest_component = std::max(out.largest_component, members);
  }
  return out;
}

}  // namespace mmgrasp
