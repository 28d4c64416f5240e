// Text that one takes along: a command with its button.

// The command, and a button that copies it.
export function copyable(command) {
  const line = Object.assign(document.createElement("p"), { className: "command" });
  const code = Object.assign(document.createElement("code"), { textContent: command, tabIndex: 0 });
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: "Copy" });
  button.addEventListener("click", async () => {
    button.textContent = (await copied(command)) ? "Copied" : "Press Ctrl+C";
    if (button.textContent !== "Copied") getSelection().selectAllChildren(code);
  });
  line.append(code, " ", button);
  return line;
}

// Whether the text is in the clipboard now. Browsers give that to pages of this computer, or under https, only.
export async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}
