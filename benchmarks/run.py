"""`make bench`: measure the speed of particles and structure, print one table, write results/latest.json.

Only ratios taken in one run on one machine count. Rows that need another code are measured if
`make bench-peers` has installed it, and stay empty otherwise. A run of some groups leaves the rest
of the file as it is.
"""

import argparse

import accuracy
import coupled_share
import features
import features_figure
import features_of_runs
import figure
import interfaces
import measures
import peers
import processes
import report
import search
import search_figure
import structure_figure
import structure_steps
from rich.console import Console

FEATURES, SEARCH = "features", "search"
MILLION = "million"  # unknowns: three minutes, only on demand
ACCURACY = "accuracy"  # of the presets: twenty minutes, only on demand
ON_DEMAND = (MILLION, ACCURACY)


def feature_costs(found: list[features.Cost]) -> measures.Numbers:
    """Measure every feature, put its cost into `found`, return the ratios that have goals."""
    found += features.costs()
    whole = next(cost.whole for cost in found if cost.feature == features.FULL)
    found += features_of_runs.costs(whole)
    return dict(features.ratios(found))


def search_costs(found: list[search.Cost]) -> measures.Numbers:
    """Measure every way to find contacts into `found`, return where one begins to beat another."""
    found += search.costs(threads=(1, 2) if measures.two_cores() else (1,))
    return dict(search.crossovers(cost._asdict() for cost in found))


def preset_errors() -> measures.Numbers:
    """Write the page of what presets cost and how far off they are; it has no ratios with goals."""
    accuracy.measure()
    return {}


def main() -> None:
    """Run all measurements, or those named."""
    groups = {
        "threads": lambda: measures.threads_15k(rates),
        "sizes": lambda: measures.sizes(rates),
        FEATURES: lambda: feature_costs(features_found),
        SEARCH: lambda: search_costs(search_found),
        "phases": lambda: measures.phases(rates),
        "ratio": lambda: measures.size_ratio(rates),
        "start": processes.starts,
        "few": measures.few_discs,
        "interfaces": interfaces.interfaces,
        "coupled": coupled_share.coupled,
        "structure": lambda: structure_steps.steps(steps),
        MILLION: lambda: structure_steps.million(steps),
        ACCURACY: preset_errors,
    }
    usual = [name for name in groups if name not in ON_DEMAND]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "groups",
        nargs="*",
        metavar="group",
        help=f"any of {', '.join(groups)}; default: all but {', '.join(ON_DEMAND)}",
    )
    parser.add_argument("--draw", action="store_true", help="draw the pictures of the last results, measure nothing")
    asked = parser.parse_args()
    if asked.draw:
        for picture in (structure_figure, features_figure, search_figure, figure):
            print(f"drawn: {picture.draw(report.read())}")
        return
    chosen = asked.groups or usual
    if unknown := set(chosen) - set(groups):
        parser.error(f"unknown group {', '.join(sorted(unknown))}: take any of {', '.join(groups)}")
    rates, steps, features_found, search_found = measures.Rates(), structure_steps.Rows(), [], []
    console = Console(stderr=True)
    values: measures.Numbers = {}
    for name in chosen:
        with console.status(f"measuring {name}"):
            values |= groups[name]()
        console.print(f"{name}: done")
    complete = set(usual) <= set(chosen)
    more: dict[str, object] = {}
    if complete and peers.installed():
        with console.status("measuring LAMMPS"):
            comparison = peers.measure()
        values |= comparison.ratios
        more["peers"] = report.joined_peers(comparison.section)
    if steps.rows:
        more["structure"] = report.joined_structure(steps.rows)
    if features_found:
        more[FEATURES] = [cost._asdict() for cost in features_found]
    if search_found:
        more[SEARCH] = [cost._asdict() for cost in search_found]
    report.write(values, rates.rows, anew=complete, **more)
    report.show()
    if steps.rows:
        console.print(f"drawn: {structure_figure.draw(report.read())}")
    if features_found:
        console.print(f"drawn: {features_figure.draw(report.read())}")
    if search_found:
        console.print(f"drawn: {search_figure.draw(report.read())}")
    if "sizes" in chosen:
        console.print(f"drawn: {figure.draw(report.read())}")


if __name__ == "__main__":
    main()
