// What outlives the page: a link that restores everything, and the scene's file.
import { copied, copyable } from "./copying.js";
import { post, postForFile } from "./server.js";
import { asFragment, fromFragment, isSame } from "./settings.js";

const AT_START = { changes: {}, effects: {} };

export function start(context) {
  startLink(context);
  startSave(context);
}

function startLink({ settings, stage, connection, start, say }) {
  const dialog = document.getElementById("link-dialog");
  const text = document.getElementById("link-text");
  const paste = document.getElementById("link-paste");
  const result = document.getElementById("link-result");
  let taken = settings.current; // the last that the server found to be a scene
  let refused = null; // the last that it did not

  // The address bar goes along, without an entry of its own in the browser's history: undo is ours.
  settings.addEventListener("change", ({ detail }) => detail.moving || write());
  stage.addEventListener("view", write);
  stage.addEventListener("still", () => (taken = stage.picture().settings));
  connection.addEventListener("message", ({ detail }) => detail.level === "error" && "number" in detail && check());
  addEventListener("hashchange", restoreAddress);
  if (location.hash) restoreAddress();

  document.getElementById("link").addEventListener("click", async () => {
    text.value = address();
    result.textContent = "";
    dialog.showModal();
    await copy();
  });
  document.getElementById("link-copy").addEventListener("click", copy);
  document.getElementById("link-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    result.textContent = await pasted(paste.value.trim());
    if (result.textContent) return paste.focus();
    paste.value = "";
    dialog.close();
  });
  closable(dialog);

  async function copy() {
    text.select();
    result.textContent = (await copied(text.value)) ? "Copied." : "Press Ctrl+C to copy it.";
  }

  // A link that restores nothing is none: what was refused is left out.
  function address() {
    const kept = isSame(settings.current, refused) ? taken : settings.current;
    const isAtStart = stage.view === "picture" && isSame(kept, AT_START);
    return location.href.split("#")[0] + (isAtStart ? "" : asFragment(kept, stage.view));
  }

  function write() {
    history.replaceState(null, "", address());
  }

  // A wish got no picture. Its settings may be no scene, or a shader is broken, and they are to outlive that.
  async function check() {
    const asked = settings.current;
    try {
      await postForFile("scene.toml", { settings: asked });
      taken = asked;
    } catch (error) {
      if (!error.isRefusal) return;
      refused = asked;
      write();
    }
  }

  async function restoreAddress() {
    const { problem, isOver } = await restore(() => location.hash);
    if (isOver) write();
    else say("error", `${problem} Reload the page to try again.`);
  }

  // The problem, "" if there is none.
  async function pasted(link) {
    if (!link) return "Paste a link first.";
    return (await restore(() => (link.startsWith("#") ? link : new URL(link).hash))).problem;
  }

  // Takes up the settings of a link's fragment, once the server has found them to be a scene: {problem, isOver: whether
  // another attempt would end the same}.
  async function restore(fragment) {
    try {
      const found = read(fragment);
      await postForFile("scene.toml", { settings: found.settings });
      const view = Object.hasOwn(start.views, found.view) ? found.view : "picture"; // of another version, perhaps
      if (stage.view !== view) stage.view = view;
      settings.replace(found.settings);
      return { problem: "", isOver: true };
    } catch (error) {
      if (!error.isRefusal) return { problem: `The tuner could not be asked about this link: ${error.message}`, isOver: false };
      const problem = `This link restores nothing: ${error.message}`;
      say("error", problem);
      return { problem, isOver: true };
    }
  }
}

// What `fragment()` of a link holds: {settings, view}.
function read(fragment) {
  let found = null;
  try {
    const text = fragment();
    found = text === "" ? { settings: AT_START, view: "picture" } : fromFragment(text);
  } catch {
    // said below: what is wrong with it is of no use to a reader
  }
  if (!found) throw Object.assign(new Error("it is cut off or mistyped; copy the whole of it."), { isRefusal: true });
  return found;
}

function startSave({ settings, start, say }) {
  const dialog = document.getElementById("save-dialog");
  const file = document.getElementById("save-file");
  const result = document.getElementById("save-result");
  const button = document.getElementById("save");

  document.getElementById("save-where").textContent = `In ${start.folder}, where the tuner was started, or as a download.`;
  button.setAttribute("aria-keyshortcuts", "Control+S");
  button.addEventListener("click", open);
  addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() !== "s" || !(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey) return;
    event.preventDefault(); // the browser would save the page
    if (!document.querySelector("dialog[open]")) open();
  });
  document.getElementById("save-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    await attempt(async () => {
      const { scene, command } = await post("save", { settings: settings.current, file: file.value });
      tell(`Written: ${scene}`, copyable(command));
      say("info", `${scene} is written; ${command} draws it.`);
    });
  });
  document.getElementById("download").addEventListener("click", () =>
    attempt(async () => {
      download(await postForFile("scene.toml", { settings: settings.current }), file.value || "scene.toml");
      tell("Downloaded.");
    }),
  );
  closable(dialog);

  function open() {
    result.replaceChildren();
    dialog.showModal();
    file.setSelectionRange(0, file.value.lastIndexOf("."));
  }

  async function attempt(task) {
    try {
      await task();
    } catch (problem) {
      tell(problem.message);
      result.firstElementChild.classList.add("problem");
    }
  }

  function tell(words, command) {
    const sentence = Object.assign(document.createElement("p"), { textContent: words });
    result.replaceChildren(sentence, ...(command ? [command] : []));
  }
}

function download(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

function closable(dialog) {
  dialog.querySelector(".close").addEventListener("click", () => dialog.close());
}
