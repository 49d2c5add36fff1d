// What may stand where the caret is, by the JSON Schema of the scene's system: keys that are not there yet, and words.

/** The tables that a part of a schema allows. */
function tables(schema) {
  if (!schema) return [];
  if (schema.oneOf) return schema.oneOf.flatMap(tables);
  if (schema.anyOf) return schema.anyOf.flatMap(tables);
  if (schema.items) return tables(schema.items);
  return schema.properties ? [schema] : [];
}
const within = (all, name) => all.flatMap(({ properties }) => tables(properties[name]));

/** {table, line, present}: the path of the table that the caret is in, its line up to the caret, and the table's keys. */
export function contextOf(text, caret) {
  const lines = text.slice(0, caret).split("\n");
  const header = (line) => /^\s*\[+([\w.]+)\]+/.exec(line)?.[1].split(".");
  const begun = lines.findLastIndex((line) => header(line));
  const after = text.split("\n").slice(begun + 1);
  const ends = after.findIndex((line) => header(line));
  const own = ends < 0 ? after : after.slice(0, ends);
  return {
    table: begun < 0 ? [] : header(lines[begun]),
    line: lines[lines.length - 1],
    present: own.map((line) => /^\s*(\w+)\s*=/.exec(line)?.[1]).filter(Boolean),
  };
}

/** [{text, insert, about}]: what may be written at the caret, `insert` being what is still missing of it. */
export function offers(schema, text, caret) {
  const { table, line, present } = contextOf(text, caret);
  const here = table.reduce(within, tables(schema));
  const given = /^\s*(\w+)\s*=\s*"?(\w*)$/.exec(line);
  if (given) {
    const [, key, begun] = given;
    const words = here.flatMap(({ properties }) => properties[key]?.enum ?? []);
    const quote = line.includes('"') ? "" : '"';
    return [...new Set(words)].filter((word) => word.startsWith(begun))
      .map((word) => ({ text: word, insert: `${quote}${word.slice(begun.length)}"`, about: "" }));
  }
  const begun = /^\s*(\w*)$/.exec(line)?.[1];
  if (begun === undefined) return [];
  const found = new Map();
  for (const { properties } of here)
    for (const [name, value] of Object.entries(properties))
      if (name.startsWith(begun) && !present.includes(name) && tables(value).length === 0)
        found.set(name, { text: name, insert: `${name.slice(begun.length)} = `, about: value.description ?? "" });
  return [...found.values()];
}

/** Offers below an editor, to be taken with a click or by Tab and Enter. */
export class Completion {
  /** `ask(system)` is answered by `hear`. */
  constructor(editor, list, ask) {
    Object.assign(this, { editor, list, ask, schemas: new Map() });
    for (const event of ["keyup", "click", "input", "focus"]) editor.addEventListener(event, () => this.show());
  }

  hear({ system, schema }) {
    this.schemas.set(system, schema);
    this.show();
  }

  show() {
    const { editor } = this;
    const system = /^system\s*=\s*"(\w+)"/m.exec(editor.value)?.[1] ?? "";
    if (!this.schemas.has(system)) {
      this.schemas.set(system, {});
      this.ask(system);
    }
    this.list.replaceChildren();
    for (const { text, insert, about } of offers(this.schemas.get(system), editor.value, editor.selectionStart)) {
      const button = document.createElement("button");
      button.textContent = text;
      button.title = about;
      // The editor keeps the focus: a scene that is being written is not read yet.
      button.addEventListener("mousedown", (event) => event.preventDefault());
      button.addEventListener("click", () => {
        editor.setRangeText(insert, editor.selectionStart, editor.selectionEnd, "end");
        editor.focus();
        this.show();
      });
      this.list.append(button);
    }
  }
}
