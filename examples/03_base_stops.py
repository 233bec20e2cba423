"""The pieces behind a round: base regions, robust intersections, and the least number of stops."""

from pathlib import Path

import mmgrasp as mg

scenario = mg.load_scenario(Path(mg.__file__).parent / "assets" / "scenarios" / "storeroom.yaml")
scenario.reach = {"samples": 500_000}  # a smaller database than the scenario asks for
problem, database = scenario.problem(), scenario.reach_database()
print(database)

grid = mg.base.make_base_grid(problem, database)
regions = mg.base.compute_base_regions(problem, database, grid)
for region in regions:
    print(region, "limited by", min(region.explanations, key=lambda e: e.base_poses_feasible))

shared = mg.base.robust_intersections(grid, regions, scenario.positioning_uncertainty)
print(shared)
stops = mg.base.cover_from_intersections(grid, shared.robust, len(regions))
print(stops, "- at least", stops.lower_bound, "are needed")
for stop in stops.stops:
    print(
        "  stand at",
        stop.pose.round(2),
        "within",
        round(stop.radius, 3),
        "m for",
        [regions[t].tray for t in stop.trays],
    )
