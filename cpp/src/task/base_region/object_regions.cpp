#include "mmgrasp/task/object_regions.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "task/base_region/region_search.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {

struct ObjectRegions::Impl {
  PartSupplyProblem problem;
  BaseGrid grid;
  std::unique_ptr<detail::RegionSearch> search;
  bool complete = false;

  Impl(const PartSupplyProblem& wanted, const ReachDatabase& database, const BaseGrid& cells)
      : problem(wanted),
        grid(cells),
        search(std::make_unique<detail::RegionSearch>(problem, database, cells, BasePoseEvaluator(problem, database),
                                                      true)) {}

  void check_tray(TrayId tray) const {
    require(complete, "regions", "stopped", "must be complete");
    require(tray >= 0 && tray < search->trays(), "tray", tray, "must be one of the problem's trays");
  }

  void check_part(PartRef part) const {
    check_tray(part.tray);
    require(search->present(part), "part", part.part, "must be a part of the tray that is in place");
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

std::vector<int> ObjectRegions::parts(TrayId tray) const {
  impl_->check_tray(tray);
  return impl_->search->parts(tray);
}

CellMask ObjectRegions::region(TrayId tray, const std::vector<int>& parts) const {
  impl_->check_tray(tray);
  if (parts.empty()) throw InvalidInput("parts: must not be empty");
  for (int part : parts) {
    impl_->check_part({tray, part});
    require(detail::part_of(impl_->problem, {tray, part}).target, "part", part, "must be a target");
  }
  CellMask cells(impl_->grid.size(), 0);
  impl_->search->common_cells(tray, parts, cells);
  return cells;
}

BaseRegion ObjectRegions::base_region(TrayId tray) const {
  impl_->check_tray(tray);
  return impl_->search->region(tray);
}

bool ObjectRegions::remove(const std::vector<PartRef>& removed, const Monitor& monitor) {
  for (const PartRef& part : removed) impl_->check_part(part);
  for (auto it = removed.begin(); it != removed.end(); ++it)
    require(std::find(it + 1, removed.end(), *it) == removed.end(), "part", it->part, "must not be named twice");
  auto rest = std::make_unique<detail::RegionSearch>(*impl_->search);
  rest->resume_without(removed);
  if (!rest->run(0, rest->trays(), monitor)) return false;
  impl_->search = std::move(rest);
  return true;
}

}  // namespace mmgrasp
