"""Runs of the program for scripts/evaluate."""

import json
import os
import subprocess

meshgrain = os.environ["MESHGRAIN"]


def run(*arguments):
    return subprocess.run([meshgrain, *map(str, arguments)], check=True, capture_output=True,
                          text=True).stdout


def stats(*arguments):
    return json.loads(run("stats", *arguments, "--json"))


def cell(value):
    return str(value) if isinstance(value, int) else f"{value:.3g}"
