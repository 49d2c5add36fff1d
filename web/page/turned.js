// Sliders for the numbers of a scene, and choices for its words.

export const literal = (values, isList) => (isList ? `[${values.map(exact).join(", ")}]` : exact(values[0]));
/** As TOML reads it: with a point, so that it is no whole number. */
const exact = (value) => (Number.isInteger(value) && Math.abs(value) < 1e15 ? `${value}.0` : String(value));

function number(labelText, value, changed) {
  const label = document.createElement("label");
  const words = document.createElement("span");
  words.textContent = labelText;
  const [slider, field] = ["range", "number"].map((type) => {
    const input = document.createElement("input");
    input.type = type;
    input.step = "any";
    return input;
  });
  const reach = Math.abs(value) || 1;
  slider.min = value > 0 ? value / 50 : value - 2 * reach;
  slider.max = value + 2 * reach;
  slider.value = field.value = value;
  slider.setAttribute("aria-label", labelText);
  slider.step = reach / 200;
  slider.addEventListener("input", () => {
    field.value = Number(slider.value).toPrecision(6) * 1;
    changed(Number(field.value));
  });
  field.addEventListener("change", () => {
    if (field.value === "" || !Number.isFinite(Number(field.value))) return;
    slider.value = field.value;
    changed(Number(field.value));
  });
  label.append(words, slider, field);
  return label;
}

function choice(labelText, words, value, changed) {
  const label = document.createElement("label");
  const name = document.createElement("span");
  name.textContent = labelText;
  const select = document.createElement("select");
  for (const word of words) select.add(new Option(word, word, false, word === value));
  select.addEventListener("change", () => changed(select.value));
  label.append(name, select);
  return label;
}

/** One control for every number and word; `changed(path, TOML)` hears of each change. */
export function controls(parent, turned, changed) {
  parent.replaceChildren();
  for (const { path, unit, meaning, value, words, is_list } of turned) {
    const about = [meaning, unit].filter(Boolean).join(", ");
    const title = `${path.split(".").pop()}${about ? ` (${about})` : ""}`;
    if (words) {
      parent.append(choice(title, words, value, (word) => changed(path, JSON.stringify(word))));
      continue;
    }
    const values = [...value];
    values.forEach((each, i) => {
      const name = values.length > 1 ? `${title} ${i + 1}` : title;
      parent.append(number(name, each, (next) => {
        values[i] = next;
        changed(path, literal(values, is_list));
      }));
    });
  }
}
