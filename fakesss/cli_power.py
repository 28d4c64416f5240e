"""The command about how many people to ask: power."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.exceptions import Exit
from tqdm import tqdm

from fakesss.cli import AS_JSON, STUDY, commands, done, say
from fakesss.problem import BadInput

if TYPE_CHECKING:
    from analysis.plan import AnalysisPlan, Mode
    from analysis.power import Search

FILE = click.Path(path_type=Path)
PEOPLE = click.IntRange(2, 100_000)


@commands.command()
@STUDY
@click.option("--effects", type=FILE, help="TOML file of the raters' effects, as of simulate (docs/survey.md).")
@click.option("--people", multiple=True, type=PEOPLE, help="Power with so many, too; may be repeated.")
@click.option("--target", default=0.8, show_default=True, help="The power that the number of people is searched for.")
@click.option("--completing", default=1.0, show_default=True, help="Share of those who start whose ratings count.")
@click.option("--most", default=1000, show_default=True, type=PEOPLE, help="Where the search ends.")
@click.option("--simulations", default=5000, show_default=True, type=click.IntRange(100), help="Studies of each size.")
@click.option("--seed", default=2011, show_default=True, type=click.IntRange(0), help="Everything follows from it.")
@click.option("-o", "--out", type=FILE, help="A CSV file for the table.")
@AS_JSON
def power(study: Path, effects: Path | None, out: Path | None, as_json: bool, **options: Any) -> None:
    """How many people STUDY needs: its declared analysis, of simulated raters with stated effects.

    Example: fakesss power my-study --effects effects.toml --people 44 --completing 0.86
    """
    try:
        stopped = tell_power(study, effects, out, as_json, options)
    except KeyboardInterrupt:
        say("fakesss: stopped before anything was known; the same command begins anew")
        raise Exit(130) from None
    if stopped:
        say("fakesss: stopped; the table says what was known by then, and the same command begins anew")
        raise Exit(130)


def tell_power(study: Path, effects: Path | None, out: Path | None, as_json: bool, options: dict[str, Any]) -> bool:
    """Searches, prints and writes what was found; whether it was interrupted."""
    from analysis.power_table import as_frame, as_text
    from fakesss.output import check_output, write_atomically

    if out is not None:
        check_output(out, [".csv"], "tables")
    found = power_of(study, effects, **options)
    for sentence in found["notes"]:
        say(sentence)
    if out is not None:
        write_atomically(out, as_frame(found["tests"]).to_csv(index=False).encode())
    done(found, as_json, as_text(found["tests"], options["target"], options["completing"], options["most"]))
    return bool(found["stopped"])


def power_of(
    study: Path,
    effects: Path | None,
    people: tuple[int, ...],
    target: float,
    completing: float,
    most: int,
    simulations: int,
    seed: int,
) -> dict[str, Any]:
    """The document of `fakesss power --json`. Interrupted, it holds what was found by then, and `stopped` is true."""
    from analysis.planned_tests import planned_tests
    from analysis.power import Search, Simulation
    from analysis.power_table import found_rows
    from analysis.study import read_manifest
    from stimuli.manifest import manifest_path
    from study_server.manifest import load_study, study_changed
    from study_server.simulation.crowd import Crowd
    from study_server.simulation.raters import default_effects, load_effects

    built = load_study(study)
    info = read_manifest(manifest_path(study))
    plan = info.plan
    check_shares(target, completing, plan.alpha)
    stated = default_effects(built) if effects is None else load_effects(effects, built)
    mode: Mode = "independent" if plan.mode == "independent" else "repeated"
    crowd = Crowd(built, stated, strangers=mode == "independent")
    means = {question.name: crowd.means(question.name) for question in info.questions}
    tests, notes = planned_tests(info, plan, mode, means)
    if not tests:
        raise BadInput(f"{study}: nothing to test: {'; '.join(notes)}; compare at least two pictures")
    largest = max(most, *people) if people else most
    simulation = Simulation(tests, crowd.answers, len(info.pictures), simulations, seed, largest)
    search = Search(simulation, target, most)
    stopped = not searched(search, people)
    return {
        "study": info.title,
        "effects": stated.model_dump(),
        "analysis": {"mode": mode, "alpha": plan.alpha, "adjust": plan.adjust, "family": plan.family},
        "target": target,
        "completing": completing,
        "most": most,
        "simulations": simulations,
        "seed": seed,
        "tests": found_rows(search, people, completing),
        "notes": [*remarks(study, study_changed(built), effects, plan, mode), *notes],
        "stopped": stopped,
    }


def check_shares(target: float, completing: float, alpha: float) -> None:
    """`BadInput` for a target that chance alone would reach or none can, or a share of people that is none."""
    if not alpha < target < 1:
        raise BadInput(f"--target {target:g}: must lie between the study's alpha, {alpha:g}, and 1; 0.8 is usual")
    if not 0.01 <= completing <= 1:
        raise BadInput(f"--completing {completing:g}: must lie between 0.01 and 1; 38 of 44 are 0.86")


def searched(search: "Search", people: tuple[int, ...]) -> bool:
    """Simulates what is asked and what the search needs, under a bar; False if it was interrupted."""
    with tqdm(unit="study", disable=None) as bar:

        def tell(size: int, studies: int) -> None:
            bar.set_postfix_str(f"{size} people", refresh=False)
            bar.update(studies)

        try:
            search.run(people, tell)
        except KeyboardInterrupt:
            return False
    return True


def remarks(study: Path, changed: bool, effects: Path | None, plan: "AnalysisPlan", mode: "Mode") -> list[str]:
    """What a reader must know before believing the numbers."""
    said = []
    if changed:
        said.append(f"{study / 'study.toml'}: has changed since the pictures were built; run fakesss build {study}")
    if effects is None:
        said.append("Effects: the defaults of simulate, whose sizes are invented; state yours with --effects FILE.")
    if mode == "independent":
        said.append("Independent samples: every picture has people of its own, and numbers of people are for one.")
    if rules := plan.exclude.model_dump(exclude_none=True):
        said.append(
            f"[analysis.exclude] {', '.join(rules)}: nobody is left out here; numbers are of people whose ratings "
            "count, and --completing says what share of those who start they are."
        )
    return said
