// What outlives the page: a link that restores everything, and the scene's file.
import { copied, copyable } from "./copying.js";
import { post, postForFile } from "./server.js";
import { asFragment, fromFragment } from "./settings.js";

export function start(context) {
  startLink(context);
  startSave(context);
}

function startLink({ settings, say }) {
  const dialog = document.getElementById("link-dialog");
  const text = document.getElementById("link-text");
  const paste = document.getElementById("link-paste");
  const result = document.getElementById("link-result");

  // The address bar goes along, without an entry of its own in the browser's history: undo is ours.
  settings.addEventListener("change", ({ detail }) => {
    if (!detail.moving) history.replaceState(null, "", address());
  });
  addEventListener("hashchange", () => restore(location.hash));
  if (location.hash) restore(location.hash);

  document.getElementById("link").addEventListener("click", async () => {
    text.value = address();
    result.textContent = "";
    dialog.showModal();
    await copy();
  });
  document.getElementById("link-copy").addEventListener("click", copy);
  document.getElementById("link-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    const problem = await restore(paste.value.slice(paste.value.indexOf("#")));
    result.textContent = problem;
    if (problem) return paste.focus();
    paste.value = "";
    dialog.close();
  });
  closable(dialog);

  async function copy() {
    text.select();
    result.textContent = (await copied(text.value)) ? "Copied." : "Press Ctrl+C to copy it.";
  }

  function address() {
    const { changes, effects } = settings.current;
    const isAtStart = !Object.keys(changes).length && !Object.keys(effects).length;
    return location.href.split("#")[0] + (isAtStart ? "" : asFragment(settings.current));
  }

  // The settings of a link's fragment, once the server has found them to be a scene; the problem if they are none.
  async function restore(fragment) {
    let problem = "";
    try {
      const found = read(fragment);
      await postForFile("scene.toml", { settings: found });
      settings.replace(found);
    } catch (error) {
      problem = `This link restores nothing: ${error.message}`;
      say("error", problem);
    }
    history.replaceState(null, "", address());
    return problem;
  }
}

function read(fragment) {
  let found = null;
  try {
    found = fragment === "" ? { changes: {}, effects: {} } : fromFragment(fragment);
  } catch {
    // said below: what is wrong with it is of no use to a reader
  }
  if (!found) throw new Error("it is cut off or mistyped; copy the whole of it.");
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
