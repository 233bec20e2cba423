#include "mmgrasp/task/object_regions.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

struct ObjectRegions::Impl {
  PartSupplyProblem problem;  // without the parts that have left
  ReachDatabase database;
  BaseGrid grid;
  std::vector<std::vector<int>> index;  // [tray][part of `problem`]: the part's index at the beginning
  std::vector<BaseRegion> regions;

  void check_tray(int tray) const {
    require(tray >= 0 && tray < static_cast<int>(index.size()), "tray", tray, "must be one of the problem's trays");
  }

  /// Where a part of the beginning is now; throws when it has left.
  std::size_t find(int tray, int part) const {
    check_tray(tray);
    const std::vector<int>& known = index[static_cast<std::size_t>(tray)];
    const auto it = std::lower_bound(known.begin(), known.end(), part);
    require(it != known.end() && *it == part, "part", part, "must be a part of the tray that is in place");
    return static_cast<std::size_t>(it - known.begin());
  }

  /// Number of a part among its tray's targets.
  std::size_t target(int tray, int part) const {
    const std::vector<Part>& parts = problem.trays[static_cast<std::size_t>(tray)].parts;
    const std::size_t place = find(tray, part);
    require(parts[place].target, "part", part, "must be a target");
    return static_cast<std::size_t>(std::count_if(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(place),
                                                  [](const Part& p) { return p.target; }));
  }
};

ObjectRegions::ObjectRegions(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ObjectRegions::ObjectRegions(ObjectRegions&&) noexcept = default;
ObjectRegions& ObjectRegions::operator=(ObjectRegions&&) noexcept = default;
ObjectRegions::~ObjectRegions() = default;

ObjectRegions ObjectRegions::compute(const PartSupplyProblem& problem, const ReachDatabase& database,
                                     const BaseGrid& grid, const Monitor& monitor) {
  auto impl =
      std::make_unique<Impl>(Impl{problem, database, grid, {}, compute_base_regions(problem, database, grid, monitor)});
  for (const Tray& tray : problem.trays) {
    impl->index.emplace_back();
    for (int p = 0; p < static_cast<int>(tray.parts.size()); ++p) impl->index.back().push_back(p);
  }
  return ObjectRegions(std::move(impl));
}

bool ObjectRegions::complete() const {
  return impl_->regions.size() == impl_->index.size();
}

const BaseGrid& ObjectRegions::grid() const {
  return impl_->grid;
}

int ObjectRegions::trays() const {
  return static_cast<int>(impl_->index.size());
}

std::vector<int> ObjectRegions::parts(int tray) const {
  impl_->check_tray(tray);
  std::vector<int> found;
  const std::vector<Part>& parts = impl_->problem.trays[static_cast<std::size_t>(tray)].parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].target) found.push_back(impl_->index[static_cast<std::size_t>(tray)][p]);
  }
  return found;
}

CellMask ObjectRegions::region(int tray, const std::vector<int>& parts) const {
  impl_->check_tray(tray);
  if (parts.empty()) throw InvalidInput("parts: must not be empty");
  CellMask cells(impl_->grid.size(), 1);
  for (int part : parts) {
    const CellMask& own = impl_->regions[static_cast<std::size_t>(tray)].part_cells[impl_->target(tray, part)];
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] &= own[i];
  }
  return cells;
}

BaseRegion ObjectRegions::base_region(int tray) const {
  impl_->check_tray(tray);
  return impl_->regions[static_cast<std::size_t>(tray)];
}

bool ObjectRegions::remove(const std::vector<std::pair<int, int>>& tray_and_part, const Monitor& monitor) {
  Impl changed = *impl_;
  for (const auto& [tray, part] : tray_and_part) {
    const auto place = static_cast<std::ptrdiff_t>(changed.find(tray, part));
    std::vector<Part>& parts = changed.problem.trays[static_cast<std::size_t>(tray)].parts;
    std::vector<int>& index = changed.index[static_cast<std::size_t>(tray)];
    parts.erase(parts.begin() + place);
    index.erase(index.begin() + place);
  }
  changed.regions = compute_base_regions(changed.problem, changed.database, changed.grid, monitor);
  if (changed.regions.size() != changed.index.size()) return false;
  *impl_ = std::move(changed);
  return true;
}

}  // namespace mmgrasp
