"""Answers of many simulated raters at once, for studies simulated by the thousand: the model of `raters`.

The random numbers are others than those of `Rater`, which has a generator for each answer so that answers do not depend
on the order of pictures; the distribution is the same.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import stats

from study_server.manifest import BuiltStudy
from study_server.settings import Question
from study_server.simulation.raters import Effects, expected

Floats = npt.NDArray[np.float64]
Answers = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Crowd:
    """Raters of `effects` over all stimuli of `study`, in the order of its manifest.

    `strangers`: every picture is judged by other people (independent samples), so that the person term is drawn for
    each answer; otherwise everybody judges every picture.
    """

    study: BuiltStudy
    effects: Effects
    strangers: bool = False

    def answers(self, question: str, people: int, studies: int, random: np.random.Generator) -> Answers:
        """Whole numbers in 1 .. scale, shape (people, studies, pictures). float32: drawing is most of a simulation.

        Random numbers are used person by person: with more people from an equal generator, the first ones are the same.
        """
        asked = self.question(question)
        pictures = len(self.study.stimuli)
        persons = pictures if self.strangers else 1
        normal = random.standard_normal((people, studies, persons + pictures), dtype=np.float32)
        drawn = np.float32(self.effects.noise_sd) * normal[..., persons:]
        drawn += np.float32(self.effects.person_sd) * normal[..., :persons]
        drawn += self.centres(asked).astype(np.float32)
        return np.clip(np.rint(drawn, out=drawn), 1, asked.scale, out=drawn)

    def means(self, question: str) -> dict[str, float]:
        """Stimulus id -> expected answer: what rounding and clipping leave of the effects, in closed form."""
        asked = self.question(question)
        spread = float(np.hypot(self.effects.person_sd, self.effects.noise_sd))
        centres = self.centres(asked)
        if spread == 0:
            means = np.clip(np.rint(centres), 1, asked.scale)
        else:
            # the mean of a whole number in 1 .. scale is 1 and, for each step above, the chance of reaching it
            steps = np.arange(2, asked.scale + 1) - 0.5
            means = 1 + stats.norm.sf((steps - centres[:, None]) / spread).sum(axis=1)
        return {stimulus.id: float(mean) for stimulus, mean in zip(self.study.stimuli, means, strict=True)}

    def centres(self, question: Question) -> Floats:
        """`expected` of every stimulus."""
        return np.array([expected(self.effects, self.study, question, each) for each in self.study.stimuli])

    def question(self, name: str) -> Question:
        """The study's question of that name."""
        return next(question for question in self.study.settings.question if question.name == name)
