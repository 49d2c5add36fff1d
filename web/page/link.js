// The whole state of a page in the fragment of its address: a link is a bug report, or homework.

const longest = 60000;
export const mostViews = 20;
const isText = (value) => typeof value === "string" && value.length <= longest;

const isView = ({ x, y, through }) => [x, y].every(isText) &&
  (through === undefined || ["column", "value", "direction"].every((name) => isText(through?.[name])) &&
    Number.isFinite(Number(through.value)));

/** {scene, settings, first, second, fair, views} as letters that an address may hold. */
export function written(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  const text = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return `#${btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "")}`;
}

/** What a fragment says; null where it is none of ours. Whoever wrote it: texts stay texts. */
export function read(fragment) {
  if (fragment.length < 2 || fragment.length > 4 * longest) return null;
  try {
    const text = atob(fragment.slice(1).replace(/-/g, "+").replace(/_/g, "/"));
    const state = JSON.parse(new TextDecoder().decode(Uint8Array.from(text, (c) => c.charCodeAt(0))));
    const { scene, settings, first, second, views = [] } = state;
    const fits = isText(scene) && isText(first) && (second === null || isText(second)) &&
      Array.isArray(settings) && settings.length <= 100 &&
      settings.every((pair) => Array.isArray(pair) && pair.length === 2 && pair.every(isText)) &&
      Array.isArray(views) && views.length <= mostViews && views.every(isView);
    return fits ? { scene, settings, first, second, fair: state.fair === true, views } : null;
  } catch {
    return null;
  }
}
