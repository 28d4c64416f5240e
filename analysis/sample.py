"""Whose ratings are analysed: who started, who completed, who is left out and by which rule."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from analysis.labels import natural_order
from analysis.plan import AnalysisPlan, Exclusions, Mode
from analysis.ratings import is_check, is_first_showing, of_one_mode, unguarded
from analysis.sessions import one_session_each
from fakesss.problem import BadInput

FINISHED = ("completed", "complete", "finished", "true", "yes", "1")
WITHDRAWN = ("withdrawn", "withdrew")
# a status comes first: who withdrew after the last answer has a time of finishing too
FINISHED_COLUMNS = ("status", "state", "completed_at", "finished_at", "completed", "finished")


@dataclass(frozen=True)
class Sample:
    """The ratings that are analysed, and the account of those that are not.

    `ratings` holds first showings only, without missing answers; `everything` also repeats and checks of the same
    people. `set_aside`: (participant, session) of those who took part twice.
    """

    ratings: pd.DataFrame
    everything: pd.DataFrame
    n_started: int
    n_completed: int
    excluded: tuple[tuple[str, str], ...]
    set_aside: tuple[tuple[str, str], ...]
    mode: Mode
    n_missing: int

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
    started, finished, withdrawn = people(ratings, answered, mode, participants)
    reasons = dict(rule_breakers(ratings, plan.exclude))
    if plan.completers_only:
        reasons |= {who: "did not complete" for who in started if who not in finished}
    reasons |= dict.fromkeys(withdrawn, "withdrew")
    kept = answered[~answered["participant"].isin(list(reasons))]
    if kept.empty:
        raise BadInput(
            f"ratings: {len(started)} started, {len(finished)} completed, and nobody is left to analyse; "
            "wait for complete sessions, or set completers_only = false in [analysis]"
        )
    return Sample(
        ratings=kept.reset_index(drop=True),
        everything=ratings[ratings["participant"].isin(kept["participant"].unique())],
        n_started=len(started),
        n_completed=len(finished),
        excluded=tuple((who, reasons[who]) for who in map(str, natural_order(reasons))),
        set_aside=set_aside,
        mode=mode,
        n_missing=int(shown.loc[~shown["participant"].isin(list(reasons)), "rating"].isna().sum()),
    )


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
        return started, set(answered["participant"]), set()
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


def rule_breakers(ratings: pd.DataFrame, rules: Exclusions) -> list[tuple[str, str]]:
    """(participant, reason) for each declared rule that somebody breaks."""
    found: list[tuple[str, str]] = []
    by_person = ratings.groupby("participant")
    if rules.failed_checks is not None and "check_passed" in ratings:
        failed = ratings["check_passed"].str.lower().isin(["false", "0", "no"]) & is_check(ratings)
        count = failed.groupby(ratings["participant"]).sum()
        found += [(str(who), f"failed {n} attention checks") for who, n in count.items() if n >= rules.failed_checks]
    if rules.median_rt_ms_below is not None and "rt_ms" in ratings:
        median = by_person["rt_ms"].median()
        fast = median[median < rules.median_rt_ms_below]
        found += [(str(who), f"median answer time {ms:.0f} ms") for who, ms in fast.items()]
    if rules.same_answer_share is not None:
        share = by_person["rating"].agg(lambda given: given.value_counts(normalize=True).max())
        flat = share[share >= rules.same_answer_share]
        found += [(str(who), f"gave one answer in {part:.0%} of the ratings") for who, part in flat.items()]
    return found
