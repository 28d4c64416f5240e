// The panel's tabs, by the keys of the ARIA Authoring Practices: arrows, Home and End. A section that is chosen gets a
// "chosen" event.

export function start() {
  const tabs = [...document.querySelectorAll("#panel [role=tab]")];

  function choose(tab) {
    for (const each of tabs) {
      const isChosen = each === tab;
      each.setAttribute("aria-selected", isChosen);
      each.tabIndex = isChosen ? 0 : -1;
      document.getElementById(each.getAttribute("aria-controls")).hidden = !isChosen;
    }
    document.getElementById(tab.getAttribute("aria-controls")).dispatchEvent(new Event("chosen", { bubbles: true }));
  }

  for (const [index, tab] of tabs.entries()) {
    tab.addEventListener("click", () => choose(tab));
    tab.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: index - 1, ArrowRight: index + 1, Home: 0, End: tabs.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      const next = tabs.at(to % tabs.length);
      choose(next);
      next.focus();
    });
  }
}
