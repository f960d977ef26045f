#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges the reports of all tasks: gather.py REPORTS TASKS

Reads REPORTS/1.jsonl … REPORTS/TASKS.jsonl (bake/recipe/README.md, "Events"), writes report.json and failures.txt, and
prints a summary. Exit code: 0 if every asset of every shard is present, else 1.
"""
import collections
import json
import pathlib
import sys

reports, tasks = pathlib.Path(sys.argv[1]), int(sys.argv[2])
counts = collections.Counter()
failures, unfinished = [], []
for task in range(1, tasks + 1):
    ended = False
    path = reports / f"{task}.jsonl"
    for line in path.read_text(errors="replace").splitlines() if path.is_file() else []:
        try:
            event = json.loads(line)
        except ValueError:
            break  # the task was killed while it wrote this line
        counts[event["event"]] += 1
        counts["bytes"] += event.get("bytes", 0) if event["event"] in ("done", "skipped") else 0
        if event["event"] == "failed":
            failures.append((event["asset"], event["error"]))
        ended = ended or event["event"] == "summary" and event["signal"] is None
    if not ended:
        unfinished.append(task)

report = {"tasks": tasks, "unfinished_tasks": unfinished, "baked": counts["done"], "up_to_date": counts["skipped"],
          "failed": counts["failed"], "canceled": counts["canceled"], "bytes": counts["bytes"],
          "failures": [{"asset": asset, "error": error} for asset, error in sorted(failures)]}
(reports / "report.json").write_text(json.dumps(report, indent=2) + "\n")
(reports / "failures.txt").write_text("".join(f"{asset}: {error}\n" for asset, error in sorted(failures)))
print(f"{report['baked']} baked, {report['up_to_date']} up to date, {report['failed']} failed, "
      f"{len(unfinished)} of {tasks} tasks did not finish")
for asset, error in sorted(failures)[:20]:
    print(f"{asset}: {error}")
if unfinished:
    print(f"unfinished tasks: {unfinished}; submit again to resume")
sys.exit(0 if not failures and not unfinished and not counts["canceled"] else 1)
