"""Whose ratings are analysed: who started, who completed, who is left out and by which rule."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from analysis.absent import with_absent
from analysis.labels import natural_order
from analysis.plan import AnalysisPlan, Exclusions, Mode
from analysis.quality import answer_times, answers, failed_checks, same_answer_share
from analysis.ratings import is_first_showing, of_one_mode
from analysis.sessions import one_session_each
from analysis.spreadsheets import unguarded
from analysis.wording import counted, joined
from fakesss.problem import BadInput

FINISHED = ("completed", "complete", "finished", "true", "yes", "1")
WITHDRAWN = ("withdrawn", "withdrew")
# a status comes first: who withdrew after the last answer has a time of finishing too
FINISHED_COLUMNS = ("status", "state", "completed_at", "finished_at", "completed", "finished")


@dataclass(frozen=True)
class LeftOut:
    """A participant whose ratings are not analysed. `rule`: a key of `[analysis]` or of `exclude`, or "withdrew"."""

    participant: str
    rule: str
    reason: str


@dataclass(frozen=True)
class Sample:
    """The ratings that are analysed, and the account of those that are not.

    `ratings` holds first showings only, without missing answers; `everything` also repeats and checks of the same
    people, `of_everyone` those of people left out too. `set_aside`: (participant, session) of those who took part
    twice.
    """

    ratings: pd.DataFrame
    everything: pd.DataFrame
    of_everyone: pd.DataFrame
    n_started: int
    n_completed: int
    left_out: tuple[LeftOut, ...]
    set_aside: tuple[tuple[str, str], ...]
    mode: Mode
    n_missing: int

    @property
    def excluded(self) -> tuple[tuple[str, str], ...]:
        """(participant, every reason for leaving them out)."""
        people = dict.fromkeys(each.participant for each in self.left_out)
        return tuple((who, "; ".join(e.reason for e in self.left_out if e.participant == who)) for who in people)

    @property
    def n_analysed(self) -> int:
        """Participants whose ratings are used."""
        return int(self.ratings["participant"].nunique())


def draw_sample(ratings: pd.DataFrame, plan: AnalysisPlan, participants: Path | None = None) -> Sample:
    """The sample that `plan` calls for. `participants`: a CSV of everyone who started, where there is one.

    Raises `BadInput` when nobody is left.
    """
    ratings, set_aside = one_session_each(ratings)
    shown = ratings[is_first_showing(ratings)]
    answered = shown.dropna(subset="rating")
    mode = choose_mode(answered, plan)
    ratings = with_absent(ratings, mode)
    shown = ratings[is_first_showing(ratings)]
    started, finished, withdrawn = people(ratings, answered, mode, participants)
    left_out = [LeftOut(who, "withdrew", "withdrew") for who in withdrawn]
    if plan.completers_only:
        missed = (who for who in started if who not in finished and who not in withdrawn)
        left_out += [LeftOut(who, "completers_only", "did not complete") for who in missed]
    left_out += rule_breakers(ratings, plan.exclude)
    order = {str(who): place for place, who in enumerate(natural_order(each.participant for each in left_out))}
    left_out.sort(key=lambda each: order[each.participant])
    kept = answered[~answered["participant"].isin(list(order))]
    if kept.empty:
        raise BadInput(
            f"ratings: {len(started)} started, {len(finished)} completed, and nobody is left to analyse: "
            f"{who_left_out(left_out)}"
        )
    return Sample(
        ratings=kept.reset_index(drop=True),
        everything=ratings[ratings["participant"].isin(kept["participant"].unique())],
        of_everyone=ratings,
        n_started=len(started),
        n_completed=len(finished),
        left_out=tuple(left_out),
        set_aside=set_aside,
        mode=mode,
        n_missing=int(shown.loc[~shown["participant"].isin(list(order)), "rating"].isna().sum()),
    )


def who_left_out(left_out: Sequence[LeftOut]) -> str:
    """Which rules left how many out, and how to mend that."""
    count = Counter(each.rule for each in left_out)
    names = {rule: rule if rule in ("withdrew", "completers_only") else f"exclude.{rule}" for rule in count}
    said = [f"{names[rule]} left out {n}" for rule, n in count.items()] or ["nobody gave an answer"]
    mends = ["wait for complete sessions, or set completers_only = false in [analysis]"] * ("completers_only" in count)
    declared = [name for name in names.values() if name.startswith("exclude.")]
    mends += [f"loosen {joined(declared)} in [analysis]"] if declared else []
    return "; ".join([joined(said), *(mends or ["wait for answers"])])


def choose_mode(answered: pd.DataFrame, plan: AnalysisPlan) -> Mode:
    """The declared mode; auto: repeated measures unless nobody rated two pictures on one question."""
    if plan.mode != "auto":
        return plan.mode
    pictures_each = answered.groupby(["participant", "question"])["stimulus"].nunique()
    return "repeated" if (pictures_each > 1).any() else "independent"


def people(
    ratings: pd.DataFrame, answered: pd.DataFrame, mode: Mode, participants: Path | None
) -> tuple[list[str], set[str], set[str]]:
    """Everyone who started, who completed and who withdrew: by the participants file, else by their ratings."""
    started = [str(who) for who in natural_order(ratings["participant"])]
    if participants is not None:
        listed, finished, withdrawn = read_participants(participants)
        started = [str(who) for who in natural_order([*started, *listed])]
        if finished is not None:
            return started, finished, withdrawn
    if mode == "independent" and not (answered.groupby("participant")["stimulus"].nunique() > 1).any():
        return started, set(answered["participant"].unique()), set()
    cells = answered.groupby(["stimulus", "question"]).ngroups
    count = answered.groupby("participant").size()
    return started, {str(who) for who in count.index[count == cells]}, set()


def read_participants(path: Path) -> tuple[list[str], set[str] | None, set[str]]:
    """The participants of one mode in a CSV, those who finished (None where the file does not say), and who withdrew.

    Who withdrew once and finished another time has finished.
    """
    try:
        frame = pd.read_csv(path, dtype=str, keep_default_na=False, encoding="utf-8-sig")
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; check the path") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read ({error}); it must be a CSV file in UTF-8") from None
    if "participant" not in frame:
        raise BadInput(f'{path}: no column "participant"; export the participants again')
    frame = of_one_mode(frame.assign(participant=unguarded(frame["participant"])))
    column = next((name for name in FINISHED_COLUMNS if name in frame), None)
    if column is None:
        return list(frame["participant"]), None, set()
    text = frame[column].str.strip().str.lower()
    done = text != "" if column.endswith("_at") else text.isin(FINISHED)
    finished = set(frame.loc[done, "participant"])
    return list(frame["participant"]), finished, set(frame.loc[text.isin(WITHDRAWN), "participant"]) - finished


def rule_breakers(ratings: pd.DataFrame, rules: Exclusions) -> list[LeftOut]:
    """Whoever breaks a declared rule, once for each rule."""
    found: list[LeftOut] = []
    if rules.failed_checks is not None:
        failed = failed_checks(ratings)
        for who, n in failed[failed >= rules.failed_checks].items():
            found.append(LeftOut(str(who), "failed_checks", f"failed {counted(int(n), 'attention check')}"))
    if rules.median_rt_ms_below is not None:
        median = answer_times(answers(ratings), 0.0)["median_rt_ms"]
        for who, ms in median[median < rules.median_rt_ms_below].items():
            found.append(LeftOut(str(who), "median_rt_ms_below", f"median answer time {ms:.0f} ms"))
    if rules.same_answer_share is not None:
        share = same_answer_share(answers(ratings))
        for who, part in share[share >= rules.same_answer_share].items():
            found.append(LeftOut(str(who), "same_answer_share", f"gave one answer in {part:.0%} of the ratings"))
    return found
