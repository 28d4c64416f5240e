// Buttons that have nothing to do for now. They keep the focus: who presses one until it is done stays where they were.

export function setPressable(button, isPressable) {
  button.setAttribute("aria-disabled", !isPressable);
}
