#include "geometry/segmentation/grow_regions.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace mmgrasp::detail {

std::vector<int> connected_regions(const FaceGraph& graph, const std::vector<char>& open,
                                   const std::vector<char>& passable, double least_area) {
  std::vector<int> labels(graph.faces.size(), -1);
  std::vector<std::vector<int>> regions;
  for (int begin = 0; begin < graph.size(); ++begin) {
    if (!open[begin] || labels[begin] >= 0) continue;
    const int label = static_cast<int>(regions.size());
    std::vector<int> faces{begin};
    labels[begin] = label;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      for (int i = graph.first_border[faces[k]]; i < graph.first_border[faces[k] + 1]; ++i) {
        const int other = graph.other(graph.border_of[i], faces[k]);
        if (!passable[graph.border_of[i]] || !open[other] || labels[other] >= 0) continue;
        labels[other] = label;
        faces.push_back(other);
      }
    }
    regions.push_back(std::move(faces));
  }
  std::vector<double> areas(regions.size(), 0);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const int f : regions[r]) areas[r] += graph.areas[f];
  }
  if (regions.empty()) return labels;
  const double limit = std::min(least_area, *std::max_element(areas.begin(), areas.end()));
  int kept = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const int label = areas[r] >= limit ? kept++ : -1;
    for (const int f : regions[r]) labels[f] = label;
  }
  return labels;
}

void grow_regions(const FaceGraph& graph, const std::vector<char>& open, std::vector<int>& labels) {
  using Step = std::tuple<double, double, int, int>;  // inward bend, distance grown, face, label
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  const auto offer = [&](int face, double grown) {
    for (int i = graph.first_border[face]; i < graph.first_border[face + 1]; ++i) {
      const int other = graph.other(graph.border_of[i], face);
      if (!open[other] || labels[other] >= 0) continue;
      const double inward = std::max(0.0, -graph.borders[graph.border_of[i]].bend);
      // A bend of less than three degrees is the roundness of a facet.
      steps.emplace(inward < 0.05 ? 0 : inward, grown + (graph.centres[other] - graph.centres[face]).norm(), other,
                    labels[face]);
    }
  };
  for (int f = 0; f < graph.size(); ++f) {
    if (labels[f] >= 0) offer(f, 0);
  }
  while (!steps.empty()) {
    const auto [bend, grown, face, label] = steps.top();
    steps.pop();
    if (labels[face] >= 0) continue;
    labels[face] = label;
    offer(face, grown);
  }
}

void dissolve_islands(const FaceGraph& graph, double least_area, std::vector<int>& labels) {
  const std::vector<char> all(graph.faces.size(), 1);
  std::vector<char> same(graph.borders.size());
  for (std::size_t k = 0; k < same.size(); ++k) {
    same[k] = labels[graph.borders[k].first] == labels[graph.borders[k].second];
  }
  const std::vector<int> pieces = connected_regions(graph, all, same, least_area);
  for (std::size_t f = 0; f < labels.size(); ++f) {
    if (pieces[f] < 0) labels[f] = -1;
  }
  grow_regions(graph, all, labels);
}

}  // namespace mmgrasp::detail
