#include "mmgrasp/collision/add_cells.hpp"

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

void add_cells(World& world, const std::string& name, const std::vector<Voxels>& cells, const Pose& T_world_cells) {
  require(!cells.empty(), "object '" + name + "' cells", "0", "must hold at least one: nothing there is occupied");
  WorldObject object;
  object.T_world_object = T_world_cells;
  for (const Voxels& of_one_size : cells) {
    LinkShape shape;
    shape.shape = of_one_size;
    object.shapes.push_back(shape);
  }
  world.add(name, std::move(object));
}

}  // namespace mmgrasp
