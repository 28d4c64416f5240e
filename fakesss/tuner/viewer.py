"""One browser tab: its wishes come in, one frame for the newest goes out."""

import asyncio
import json
import logging
import time
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from fakesss.problem import BadInput, validated
from fakesss.scene import Scene
from fakesss.shader_source import ShaderError
from fakesss.tuner.frames import Asked
from fakesss.tuner.moving import Pace
from fakesss.tuner.preparing import Attempt, attempt, in_words
from fakesss.tuner.state import Tuner
from fakesss.tuner.studio import Unprepared
from fakesss.tuner.wishes import Wish

log = logging.getLogger(__name__)

Level = Literal["error", "warning", "info"]


@dataclass
class Making:
    """What is being made for this viewer."""

    missing: Unprepared
    what: str
    task: "asyncio.Task[None]"


class Viewer:
    """Draws for one tab as long as it is open. All that it has under way ends with it."""

    def __init__(self, tuner: Tuner, socket: WebSocket) -> None:
        self.tuner, self.socket = tuner, socket
        self.pace = Pace()
        self.last: Scene | None = None  # all of it was at hand
        self.newest: tuple[Wish, float] | None = None  # and when it came
        self._asked = asyncio.Event()
        self._making: Making | None = None
        self._tasks = asyncio.TaskGroup()

    async def watch(self) -> None:
        """Until the tab is closed."""
        await self.socket.accept()
        self.tuner.viewers.add(self)
        try:
            async with self._tasks:
                self._tasks.create_task(self._listen())
                self._tasks.create_task(self._answer())
        except* WebSocketDisconnect:
            pass  # the tab was closed, which is how watching ends
        finally:
            self.tuner.viewers.discard(self)
        if not self.tuner.viewers:
            await self.tuner.studio.rest()

    def tell(self, kind: str, **facts: Any) -> None:
        """Send a message that is no frame, without waiting for a slow connection."""
        if self.socket.client_state is WebSocketState.CONNECTED:
            self._tasks.create_task(self._send(json.dumps({"type": kind, **facts})))

    def say(self, level: Level, text: str, number: int | None = None) -> None:
        """A sentence for the page's messages; with the `number` of a wish, that one gets no frame."""
        self.tell("message", level=level, text=text, **({} if number is None else {"number": number}))

    async def _listen(self) -> None:
        while True:
            message = await self.socket.receive()
            if message["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(message["code"])
            try:
                self.newest = read_wish(message.get("text")), time.perf_counter()
            except Refused as refused:
                self.say("error", str(refused), refused.number)
            else:
                self._asked.set()

    async def _answer(self) -> None:
        while True:
            await self._asked.wait()
            async with self.tuner.studio.turn:
                self._asked.clear()
                assert self.newest is not None
                wish, since = self.newest  # those before it are forgotten
                wait = 1e3 * (time.perf_counter() - since)
                found = await self._attempt(wish)
            if found is None:
                continue
            if found.drawn is None:
                assert found.missing is not None
                what = in_words(found.missing.kind, self.tuner.scene(wish.settings))
                self.say("info", f"{what} is being made; the picture follows.", wish.number)
            else:
                await self._send(found.drawn.message(wish.number, wait, found.stand_in))
            if found.missing and not (wish.moving and found.drawn):
                self._make(found.missing, self.tuner.scene(wish.settings))
            elif not wish.moving:
                self._give_up()

    async def _attempt(self, wish: Wish) -> Attempt | None:
        """What the studio makes of a wish; None where the answer is a sentence, which was said."""
        try:
            scene = self.tuner.scene(wish.settings)
            scale = self.pace.scale(scene.size[0] * scene.size[1]) if wish.moving else 1
            asked = Asked(scene, wish.settings.forced, wish.view, wish.moving, scale)
            found = await self.tuner.studio.do(partial(attempt, asked=asked, last=self.last))
        except (BadInput, ShaderError) as error:
            self.say("error", str(error), wish.number)
            return None
        except Exception:
            log.exception("drawing failed")
            self.say("error", "This could not be drawn, a fault of the program; its terminal tells more.", wish.number)
            return None
        if found.drawn and found.drawn.is_usual:
            self.pace.note(wish.moving, found.drawn.samples, found.drawn.header["times"]["draw"])
        if found.drawn and not found.missing:
            self.last = scene
        return found

    async def _send(self, message: str | bytes) -> None:
        try:
            await (self.socket.send_text(message) if isinstance(message, str) else self.socket.send_bytes(message))
        except RuntimeError as error:  # the connection was closed at our end meanwhile
            raise WebSocketDisconnect from error

    def _give_up(self) -> None:
        """Stop what is made for an earlier picture."""
        if self._making and not self._making.task.done():
            self._making.task.cancel()
            self.tell("working", what=self._making.what, done=True)

    def _make(self, missing: Unprepared, scene: Scene) -> None:
        """Begin what a picture lacked, instead of what an earlier one did."""
        if self._making and not self._making.task.done() and self._making.missing.key == missing.key:
            return
        self._give_up()
        what = in_words(missing.kind, scene)
        self.tell("working", what=what, done=False)
        self._making = Making(missing, what, self._tasks.create_task(self._prepare(missing, what, scene.object)))

    async def _prepare(self, missing: Unprepared, what: str, name: str) -> None:
        try:
            await self.tuner.prepare(missing)
            if missing.kind == "mesh":
                await self.tuner.mesh(name)  # what else is to be known before anything of it can be drawn
        except BadInput as error:
            self.say("error", str(error))
        except Exception:
            log.exception("making failed")
            self.say("error", f"{what} could not be made, a fault of the program; its terminal tells more.")
        else:
            self.tell("again")
        self.tell("working", what=what, done=True)


class Refused(ValueError):
    """A message that is no wish: one sentence, and the wish's number if it has one."""

    def __init__(self, sentence: str, number: int | None = None) -> None:
        super().__init__(sentence)
        self.number = number


def read_wish(text: str | None) -> Wish:
    """The wish that a message holds, or `Refused`."""
    try:
        data = json.loads(text or "")
    except (ValueError, RecursionError):
        raise Refused("wish: is no JSON; reload the page") from None
    if not isinstance(data, dict):
        raise Refused("wish: must be a table with number and settings; reload the page")
    number = data.get("number")
    try:
        return validated(Wish, data, "wish")
    except BadInput as error:
        raise Refused(str(error), number if type(number) is int else None) from None
