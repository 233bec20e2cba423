#include "geometry/segmentation/alpha_expansion.hpp"

#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <utility>

namespace mmgrasp::detail {
namespace {

using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                 boost::no_property, int, int>;
/// A move must lower the total by this share of it.
constexpr double kGain = 1e-9;
constexpr int kMostRounds = 20;

/// One graph for all moves: an arc each way for every link, and one each way between every node and both terminals.
class ExpansionGraph {
 public:
  ExpansionGraph(int nodes, const std::vector<LabelLink>& links) : nodes_(nodes), links_(links) {
    std::vector<int> degree(nodes + 2, 2);
    degree[source()] = degree[sink()] = nodes;
    for (const LabelLink& l : links) {
      ++degree[l.a];
      ++degree[l.b];
    }
    std::vector<int> next(nodes + 2, 0);
    for (int v = 1; v < nodes + 2; ++v) next[v] = next[v - 1] + degree[v - 1];
    const std::size_t arcs = next.back() + degree.back();
    std::vector<std::pair<int, int>> ends(arcs);
    reverse_.resize(arcs);
    const auto join = [&](int a, int b) {
      const int there = next[a]++, back = next[b]++;
      ends[there] = {a, b};
      ends[back] = {b, a};
      reverse_[there] = back;
      reverse_[back] = there;
      return there;
    };
    for (int v = 0; v < nodes; ++v) {
      from_source_.push_back(join(source(), v));
      to_sink_.push_back(join(v, sink()));
    }
    for (const LabelLink& l : links) link_arc_.push_back(join(l.a, l.b));
    graph_ = Graph(boost::edges_are_sorted, ends.begin(), ends.end(), nodes + 2);
    for (auto [e, end] = boost::edges(graph_); e != end; ++e) arcs_.push_back(*e);
    reverse_arcs_.reserve(arcs);
    for (const int r : reverse_) reverse_arcs_.push_back(arcs_[r]);
    capacity_.resize(arcs);
    residual_.resize(arcs);
    predecessor_.resize(nodes + 2);
    color_.resize(nodes + 2);
    distance_.resize(nodes + 2);
  }

  /// The best change of some nodes to the label `alpha`.
  std::vector<int> expand(const Eigen::MatrixXd& costs, std::vector<int> labels, int alpha) {
    std::fill(capacity_.begin(), capacity_.end(), 0.0);
    std::vector<double> change(nodes_);  // what it costs to take alpha instead of keeping the label
    for (int v = 0; v < nodes_; ++v) change[v] = costs(alpha, v) - costs(labels[v], v);
    for (std::size_t k = 0; k < links_.size(); ++k) {
      // Cost of a link: 0 when both change, to_b when only b does, to_a when only a does, keep when neither does.
      const LabelLink& l = links_[k];
      const double keep = labels[l.a] != labels[l.b] ? l.cost : 0;
      const double to_b = labels[l.a] != alpha ? l.cost : 0, to_a = labels[l.b] != alpha ? l.cost : 0;
      change[l.a] += to_a - keep;
      change[l.b] -= to_a;
      capacity_[link_arc_[k]] = to_a + to_b - keep;  // paid when b changes and a does not
    }
    // A node on the sink's side changes.
    for (int v = 0; v < nodes_; ++v) {
      capacity_[from_source_[v]] = std::max(0.0, change[v]);
      capacity_[to_sink_[v]] = std::max(0.0, -change[v]);
    }
    const auto arc_index = boost::get(boost::edge_index, graph_);
    const auto node_index = boost::get(boost::vertex_index, graph_);
    boost::boykov_kolmogorov_max_flow(graph_, boost::make_iterator_property_map(capacity_.begin(), arc_index),
                                      boost::make_iterator_property_map(residual_.begin(), arc_index),
                                      boost::make_iterator_property_map(reverse_arcs_.begin(), arc_index),
                                      boost::make_iterator_property_map(predecessor_.begin(), node_index),
                                      boost::make_iterator_property_map(color_.begin(), node_index),
                                      boost::make_iterator_property_map(distance_.begin(), node_index), node_index,
                                      source(), sink());
    // The source's tree is the side of the cut that keeps; its black is that tree's colour.
    for (int v = 0; v < nodes_; ++v) {
      if (color_[v] != boost::black_color) labels[v] = alpha;
    }
    return labels;
  }

 private:
  int source() const { return nodes_; }
  int sink() const { return nodes_ + 1; }

  int nodes_;
  const std::vector<LabelLink>& links_;
  Graph graph_;
  std::vector<Graph::edge_descriptor> arcs_, reverse_arcs_, predecessor_;
  std::vector<int> reverse_, from_source_, to_sink_, link_arc_;
  std::vector<double> capacity_, residual_;
  std::vector<boost::default_color_type> color_;
  std::vector<int> distance_;
};

}  // namespace

double labelling_cost(const Eigen::MatrixXd& costs, const std::vector<LabelLink>& links,
                      const std::vector<int>& labels) {
  double total = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) total += costs(labels[v], static_cast<Eigen::Index>(v));
  for (const LabelLink& l : links) total += labels[l.a] != labels[l.b] ? l.cost : 0;
  return total;
}

std::vector<int> alpha_expansion(const Eigen::MatrixXd& costs, const std::vector<LabelLink>& links) {
  std::vector<int> labels(costs.cols(), 0);
  for (Eigen::Index v = 0; v < costs.cols(); ++v) costs.col(v).minCoeff(&labels[v]);
  const int count = static_cast<int>(costs.rows());
  if (count < 2 || labels.empty()) return labels;
  ExpansionGraph graph(static_cast<int>(labels.size()), links);
  double total = labelling_cost(costs, links, labels);
  int failed = 0;
  for (int move = 0; move < kMostRounds * count && failed < count; ++move) {
    std::vector<int> next = graph.expand(costs, labels, move % count);
    const double lower = labelling_cost(costs, links, next);
    if (lower < total - kGain * std::abs(total)) {
      labels.swap(next);
      total = lower;
      failed = 0;
    } else {
      ++failed;
    }
  }
  return labels;
}

}  // namespace mmgrasp::detail
