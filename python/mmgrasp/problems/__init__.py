"""Problems to plan, drawn by seed or read from published sets.

- `storerooms`: where trays stand in a storeroom and parts in a tray (P1)
- `random_trays`: trays of parts that lie at random, seen by a camera (P1 3.5.2, 3.7.2)
- `pipe_cells`: pipe structures and the work cells they are carried through (P2 figure 4.3)
- `planning_scene`: worlds written as MoveIt planning scenes
- `motion_bench`, `motion_bench_run`: MotionBenchMaker's problems for arms, read, planned and checked
"""
