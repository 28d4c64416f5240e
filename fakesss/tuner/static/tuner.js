// Wires the page's parts, and does nothing else.
import * as animate from "./animate.js";
import { Connection } from "./connection.js";
import * as controls from "./controls.js";
import * as effects from "./effects.js";
import * as gestures from "./gestures.js";
import * as hint from "./hint.js";
import * as legend from "./legend.js";
import * as lights from "./lights.js";
import * as media from "./media.js";
import * as messages from "./messages.js";
import * as objects from "./objects.js";
import * as overlay from "./overlay.js";
import * as program from "./program.js";
import { get } from "./server.js";
import { Settings } from "./settings.js";
import * as stage from "./stage.js";
import * as status from "./status.js";
import * as switches from "./switches.js";
import * as tabs from "./tabs.js";

const start = await get("start.json");
const context = { start, settings: new Settings(start), connection: new Connection() };
context.say = messages.start(context);
context.stage = stage.start(context);
context.animation = animate.start(context);
context.overlay = overlay.start(context);
for (const part of [gestures, status, legend]) part.start(context);
for (const part of [tabs, hint, lights, controls, effects, media, objects, program, switches]) part.start(context);
