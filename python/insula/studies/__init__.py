# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: sweeps of scenes, parameters, motions, rates and seeds. docs/studies.md is the manual page.

    from insula import studies

    plan = studies.plan("studies/clip_success.xml")
    studies.carry_out(plan, "results", studies.Options(workers=4))
    table = pyarrow.parquet.read_table("results/results.parquet")
"""

from insula.studies.campaign import Options, carry_out
from insula.studies.planning import Plan, plan
from insula.studies.tree import StudyError

__all__ = ["Options", "Plan", "StudyError", "carry_out", "plan"]
