// The message console: what the tuner said, the newest last.

const KEPT = 200;
const NAMES = { error: "Error", warning: "Warning", info: "Note" };

// Gives `say(level, text)`, level being "error", "warning" or "info".
export function start({ connection }) {
  const log = document.getElementById("log");
  const pane = log.parentElement; // scrolls
  const unread = document.getElementById("unread");
  const drawer = document.getElementById("messages");
  let last = null; // {level, text, times, count: where the repeats stand}
  let news = 0;

  function note(level) {
    if (!drawer.hidden || level === "info") return;
    unread.textContent = ++news;
  }

  function read() {
    news = 0;
    unread.textContent = "";
  }

  function say(level, text) {
    const isAtEnd = pane.scrollTop + pane.clientHeight >= pane.scrollHeight - 8;
    note(level);
    if (last && last.level === level && last.text === text) {
      last.count.textContent = ` × ${++last.times}`;
    } else {
      const line = entry(level, text);
      log.append(line);
      last = { level, text, times: 1, count: line.lastElementChild };
      while (log.children.length > KEPT) log.firstElementChild.remove();
    }
    if (isAtEnd) pane.scrollTop = pane.scrollHeight; // who reads further up is left there
  }

  connection.addEventListener("message", ({ detail }) => detail.type === "message" && say(detail.level, detail.text));
  document.getElementById("clear-messages").addEventListener("click", () => {
    log.replaceChildren();
    last = null;
    read();
  });
  document.getElementById("show-messages").addEventListener("click", read);
  return say;
}

function entry(level, text) {
  const line = document.createElement("li");
  line.className = level;
  const time = Object.assign(document.createElement("time"), { textContent: new Date().toLocaleTimeString() });
  const name = Object.assign(document.createElement("b"), { textContent: `${NAMES[level]}: ` });
  line.append(time, " ", name, text, document.createElement("span"));
  return line;
}
