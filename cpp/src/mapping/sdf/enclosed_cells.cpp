#include "mapping/sdf/enclosed_cells.hpp"

#include <algorithm>
#include <limits>

namespace mmgrasp::detail {
namespace {

/// Sorted coordinates of the blocks along an axis, with one place for each stretch between them that holds no block,
/// and one before and behind all.
class Axis {
 public:
  static constexpr int kNone = std::numeric_limits<int>::min();

  void finish(std::vector<int> used) {
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    places_.assign(1, kNone);
    for (const int value : used) {
      if (places_.back() != kNone && places_.back() + 1 != value) places_.push_back(kNone);
      places_.push_back(value);
    }
    places_.push_back(kNone);
  }
  int size() const { return static_cast<int>(places_.size()); }
  int key(int place) const { return places_[place]; }

 private:
  std::vector<int> places_;
};

struct Place {
  int at[3];
  int block = -1;  // among the cells' blocks; -1: free as a whole
  int cell = -1;   // of the block
};

/// Floods free and unknown cells from outside; what it does not reach is enclosed.
class Flood {
 public:
  explicit Flood(CellBlocks& cells) : cells_(cells), reached_(cells.blocks.size()) {
    for (int k = 0; k < 3; ++k) {
      std::vector<int> used;
      for (const CellBlock& block : cells.blocks) used.push_back(coordinate(block.key, k));
      axes_[k].finish(std::move(used));
    }
    whole_.assign(static_cast<std::size_t>(axes_[0].size()) * axes_[1].size() * axes_[2].size(), 0);
  }

  std::vector<BlockKey> run() {
    visit_whole({{0, 0, 0}});
    spread();
    visit_clear();
    spread();
    return fill();
  }

 private:
  static int coordinate(const BlockKey& key, int axis) { return axis == 0 ? key.x : axis == 1 ? key.y : key.z; }
  std::size_t index(const Place& p) const {
    return (static_cast<std::size_t>(p.at[0]) * axes_[1].size() + p.at[1]) * axes_[2].size() + p.at[2];
  }
  static bool has_occupied(const CellBlock& block) {
    return std::any_of(block.occupied.begin(), block.occupied.end(), [](std::uint64_t layer) { return layer != 0; });
  }
  /// The block with occupied cells at a place, or -1: then the place is free as a whole.
  int divided(const Place& p) const {
    const BlockKey key{axes_[0].key(p.at[0]), axes_[1].key(p.at[1]), axes_[2].key(p.at[2])};
    if (key.x == Axis::kNone || key.y == Axis::kNone || key.z == Axis::kNone) return -1;
    const int block = cells_.find(key);
    return block >= 0 && has_occupied(cells_.blocks[block]) ? block : -1;
  }

  void visit_whole(const Place& p) {
    char& done = whole_[index(p)];
    if (done) return;
    done = 1;
    stack_.push_back(p);
  }
  void visit_cell(const Place& p) {
    const int z = p.cell >> 6;
    const std::uint64_t bit = std::uint64_t{1} << (p.cell & 63);
    if ((cells_.blocks[p.block].occupied[z] | reached_[p.block][z]) & bit) return;
    reached_[p.block][z] |= bit;
    stack_.push_back(p);
  }

  void visit_clear() {
    Place p;
    for (p.at[0] = 0; p.at[0] < axes_[0].size(); ++p.at[0]) {
      for (p.at[1] = 0; p.at[1] < axes_[1].size(); ++p.at[1]) {
        for (p.at[2] = 0; p.at[2] < axes_[2].size(); ++p.at[2]) visit_clear_of(p);
      }
    }
  }
  void visit_clear_of(Place p) {
    const BlockKey key{axes_[0].key(p.at[0]), axes_[1].key(p.at[1]), axes_[2].key(p.at[2])};
    if (key.x == Axis::kNone || key.y == Axis::kNone || key.z == Axis::kNone) return;
    const int block = cells_.find(key);
    if (block < 0) return;
    p.block = divided(p);
    for (p.cell = 0; p.cell < kBlockVoxels; ++p.cell) {
      if (!(cells_.blocks[block].clear[p.cell >> 6] >> (p.cell & 63) & 1)) continue;
      if (p.block >= 0) {
        visit_cell(p);
      } else {
        return visit_whole({{p.at[0], p.at[1], p.at[2]}});
      }
    }
  }

  void spread() {
    while (!stack_.empty()) {
      const Place from = stack_.back();
      stack_.pop_back();
      for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) step(from, axis, side);
      }
    }
  }

  void step(const Place& from, int axis, int side) {
    const int shift = 3 * axis;  // of the axis within a cell's number
    if (from.block >= 0) {
      const int next = (from.cell >> shift & 7) + side;
      if (next >= 0 && next < kBlockSide) {
        Place to = from;
        to.cell += side * (1 << shift);
        return visit_cell(to);
      }
    }
    Place to = from;
    to.at[axis] += side;
    if (to.at[axis] < 0 || to.at[axis] >= axes_[axis].size()) return;
    to.block = divided(to);
    if (to.block < 0) return visit_whole({{to.at[0], to.at[1], to.at[2]}});
    const int entered = (side > 0 ? 0 : kBlockSide - 1) << shift;
    if (from.block >= 0) {
      to.cell = (from.cell & ~(7 << shift)) | entered;
      return visit_cell(to);
    }
    for (to.cell = 0; to.cell < kBlockVoxels; ++to.cell) {
      if ((to.cell & (7 << shift)) == entered) visit_cell(to);
    }
  }

  std::vector<BlockKey> fill() {
    std::vector<BlockKey> out;
    Place p;
    for (p.at[0] = 0; p.at[0] < axes_[0].size(); ++p.at[0]) {
      for (p.at[1] = 0; p.at[1] < axes_[1].size(); ++p.at[1]) {
        for (p.at[2] = 0; p.at[2] < axes_[2].size(); ++p.at[2]) {
          const int block = divided(p);
          if (block >= 0) {
            for (int z = 0; z < kBlockSide; ++z) cells_.blocks[block].occupied[z] |= ~reached_[block][z];
          } else if (!whole_[index(p)]) {
            // A stretch without blocks reaches out of the map, so this is one block.
            out.push_back({axes_[0].key(p.at[0]), axes_[1].key(p.at[1]), axes_[2].key(p.at[2])});
          }
        }
      }
    }
    return out;
  }

  CellBlocks& cells_;
  std::vector<BlockMask> reached_;
  Axis axes_[3];
  std::vector<char> whole_;
  std::vector<Place> stack_;
};

}  // namespace

std::vector<BlockKey> fill_enclosed(CellBlocks& cells) {
  if (cells.blocks.empty()) return {};
  return Flood(cells).run();
}

}  // namespace mmgrasp::detail
