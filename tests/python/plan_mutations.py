"""Every field of a plan changed in every way: what `verify` does not refuse. As a script: `plan_mutations.py PLAN SCENARIO`, all of them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mmgrasp as mg
from field_changes import Harmless, report, try_out
from mmgrasp._core import verify as checks
from mmgrasp.documents.reading import Document, read_json
from mmgrasp.part_supply.figures import check_figures
from mmgrasp.part_supply.plan_file import check_form
from mmgrasp.part_supply.plan_reader import plan_to_check
from mmgrasp.part_supply.plan_writer import scenario_to_dict
from mmgrasp.part_supply.verification import differences

HARMLESS: Harmless = {
    "mmgrasp": ("any", "the version that wrote the plan: reported, not used"),
}


def refuses(expected: dict[str, Any] | None, samples: int = 60) -> Callable[[dict[str, Any]], bool]:
    """Verify's answer, the quick rules first."""

    def refused(plan: dict[str, Any]) -> bool:
        try:
            if expected is not None and differences(plan.get("scenario"), expected):
                return True
            root = Document("plan", plan, {}).root
            check_form(root)
            if plan["outcome"] != "solved":
                return True
            to_check = plan_to_check(root)
            if check_figures(plan):
                return True
        except mg.Error:
            return True
        return bool(checks.check_plan(to_check, samples=samples, region_samples=5, threads=1).faults)

    return refused


def main() -> int:
    plan = read_json(Path(sys.argv[1])).root.raw
    expected = scenario_to_dict(mg.load_scenario(sys.argv[2]))
    of_each = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    return 1 if report(try_out(plan, refuses(expected, 200), of_each), HARMLESS) else 0


if __name__ == "__main__":
    sys.exit(main())
