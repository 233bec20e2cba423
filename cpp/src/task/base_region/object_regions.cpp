#include "mmgrasp/task/object_regions.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "task/base_region/region_search.hpp"

namespace mmgrasp {

struct ObjectRegions::Impl {
  PartSupplyProblem problem;
  BaseGrid grid;
  std::unique_ptr<RegionSearch> search;
  bool complete = false;

  Impl(const PartSupplyProblem& wanted, const ReachDatabase& database, const BaseGrid& cells)
      : problem(wanted), grid(cells), search(std::make_unique<RegionSearch>(problem, database, cells, true)) {}

  void check_tray(int tray) const {
    require(complete, "regions", "stopped", "must be complete");
    require(tray >= 0 && tray < search->trays(), "tray", tray, "must be one of the problem's trays");
  }

  void check_part(int tray, int part) const {
    check_tray(tray);
    require(search->present(tray, part), "part", part, "must be a part of the tray that is in place");
  }
};

ObjectRegions::ObjectRegions(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ObjectRegions::ObjectRegions(ObjectRegions&&) noexcept = default;
ObjectRegions& ObjectRegions::operator=(ObjectRegions&&) noexcept = default;
ObjectRegions::~ObjectRegions() = default;

ObjectRegions ObjectRegions::compute(const PartSupplyProblem& problem, const ReachDatabase& database,
                                     const BaseGrid& grid, const Monitor& monitor) {
  auto impl = std::make_unique<Impl>(problem, database, grid);
  impl->complete = impl->search->run(0, impl->search->trays(), monitor);
  return ObjectRegions(std::move(impl));
}

bool ObjectRegions::complete() const {
  return impl_->complete;
}

const BaseGrid& ObjectRegions::grid() const {
  return impl_->grid;
}

int ObjectRegions::trays() const {
  return impl_->search->trays();
}

std::vector<int> ObjectRegions::parts(int tray) const {
  impl_->check_tray(tray);
  return impl_->search->parts(tray);
}

CellMask ObjectRegions::region(int tray, const std::vector<int>& parts) const {
  impl_->check_tray(tray);
  if (parts.empty()) throw InvalidInput("parts: must not be empty");
  for (int part : parts) {
    impl_->check_part(tray, part);
    require(impl_->problem.trays[tray].parts[part].target, "part", part, "must be a target");
  }
  CellMask cells(impl_->grid.size(), 0);
  impl_->search->common_cells(tray, parts, cells);
  return cells;
}

BaseRegion ObjectRegions::base_region(int tray) const {
  impl_->check_tray(tray);
  return impl_->search->region(tray);
}

bool ObjectRegions::remove(const std::vector<std::pair<int, int>>& tray_and_part, const Monitor& monitor) {
  for (const auto& [tray, part] : tray_and_part) impl_->check_part(tray, part);
  for (auto it = tray_and_part.begin(); it != tray_and_part.end(); ++it) {
    require(std::find(it + 1, tray_and_part.end(), *it) == tray_and_part.end(), "part", it->second,
            "must not be named twice");
  }
  auto rest = std::make_unique<RegionSearch>(*impl_->search);
  rest->resume_without(tray_and_part);
  if (!rest->run(0, rest->trays(), monitor)) return false;
  impl_->search = std::move(rest);
  return true;
}

}  // namespace mmgrasp
