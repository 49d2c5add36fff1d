// The stationary paths of a boundary value, cheapest first, to choose among.

/** Buttons for them; `chosen` is the place of one, from 1, or 0 for the scene's own choice. */
export function showPaths(section, { stationary_paths: paths = [], cost, starts }, chosen, choose) {
  const list = section.querySelector("ul");
  list.replaceChildren();
  section.hidden = paths.length === 0;
  const own = paths.findIndex((path) => path.cost === cost) + 1;
  paths.forEach((path, i) => {
    const button = document.createElement("button");
    const kind = path.is_minimum ? "minimum" : `saddle, ${path.negative_directions} down`;
    button.textContent = `${Number(path.cost.toPrecision(6))}: ${kind}; ${path.starts} of ${starts} starts`;
    button.setAttribute("aria-pressed", String((chosen || own) === i + 1));
    button.addEventListener("click", () => choose(i + 1));
    const item = document.createElement("li");
    item.append(button);
    list.append(item);
  });
}
