#pragma once

#include "geometry/hierarchy/triangle_tree.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {

/// Fills a tree's nodes and packets. The same mesh gives the same tree everywhere.
class TreeBuilder {
 public:
  TreeBuilder(TriangleTree& tree, const TriangleMesh& mesh);

 private:
  struct Box {
    float lower[3], upper[3];
    Box();
    void extend(const Box& other);
    float area() const;
  };
  struct Item {
    Box box;
    int triangle;
    float middle(int axis) const { return box.lower[axis] + box.upper[axis]; }
  };
  struct Range {
    int begin, end;
    Box box;
    int count() const { return end - begin; }
  };

  Range range(int begin, int end) const;
  int best_split(const Range& range);
  int best_split_of_few(const Range& range);
  int build(const Range& range, int depth);
  int add_packet(const Range& range);

  TriangleTree& tree_;
  const TriangleMesh& mesh_;
  std::vector<Item> items_;
  InterruptionPoll poll_{64};
};

}  // namespace mmgrasp::detail
