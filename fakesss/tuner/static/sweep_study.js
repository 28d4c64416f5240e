// The end of the tuner: a study.toml with the pictures of the sweep.
import { copyable } from "./copying.js";
import { post } from "./server.js";

export function startStudy(sweep, { settings, say }) {
  const part = document.getElementById("sweep-study");
  const title = document.getElementById("study-title");
  const folder = document.getElementById("study-folder");
  const written = document.getElementById("study-written");
  let isOwnTitle = false; // typed, not made from the factors
  let isOwnFolder = false;

  title.addEventListener("input", () => {
    isOwnTitle = title.value !== "";
    suggest();
  });
  folder.addEventListener("input", () => (isOwnFolder = folder.value !== ""));
  sweep.addEventListener("change", suggest);
  document.getElementById("write-study").addEventListener("click", write);

  function suggest() {
    const { factors } = sweep;
    part.disabled = !factors.length;
    if (!factors.length) return;
    const names = factors.map(({ name }) => name).reverse().join(" by ");
    if (!isOwnTitle) title.value = names.charAt(0).toUpperCase() + names.slice(1);
    if (!isOwnFolder) folder.value = plain(title.value);
  }

  async function write() {
    const factors = sweep.factors.map(({ name, path, levels }) => ({ name, path, levels }));
    const asked = { settings: settings.current, title: title.value, folder: folder.value, factors };
    try {
      const { study, next } = await post("study", asked);
      tell(`Written: ${study}`, copyable(next), sweep.warning);
      say("info", `${study} is written; next: ${next}`);
    } catch (problem) {
      tell(problem.message);
      written.firstElementChild.classList.add("problem");
      say("error", problem.message);
    }
  }

  function tell(words, command, warning = "") {
    const sentence = (text) => Object.assign(document.createElement("p"), { textContent: text });
    written.replaceChildren(sentence(words), ...(command ? [command] : []), ...(warning ? [sentence(warning)] : []));
  }
}

// Letters and digits, dashes for all between: a folder's name on any system.
function plain(words) {
  return words.normalize("NFKD").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "");
}
