// What a reader takes along: files made in the page, of what it shows.

/** Offers bytes as a file of that name. */
export function save(name, type, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Columns by label as a table; what is no number is an empty cell. */
export function csv(columns) {
  const labels = Object.keys(columns);
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const cell = (value) => (Number.isNaN(value) ? "" : value);
  const rows = Array.from(columns.t, (_, row) => labels.map((name) => cell(columns[name][row])).join(","));
  return `${[labels.map(quoted).join(","), ...rows].join("\n")}\n`;
}

/** Pictures under each other, on the page's own paper. */
export function pasted(canvases) {
  const all = document.createElement("canvas");
  all.width = Math.max(...canvases.map(({ width }) => width));
  all.height = canvases.reduce((sum, { height }) => sum + height, 0);
  const paint = all.getContext("2d");
  paint.fillStyle = getComputedStyle(document.body).backgroundColor;
  paint.fillRect(0, 0, all.width, all.height);
  let top = 0;
  for (const canvas of canvases) {
    paint.drawImage(canvas, 0, top);
    top += canvas.height;
  }
  return new Promise((resolve) => all.toBlob(resolve, "image/png"));
}

/** So many seconds of a canvas that moves. Throws where the browser records none. */
export function recorded(canvas, seconds) {
  if (!window.MediaRecorder || !canvas.captureStream) throw new Error("this browser records no pictures that move");
  const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm" });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  return new Promise((resolve) => {
    recorder.onstop = () => resolve(new Blob(parts, { type: "video/webm" }));
    recorder.start();
    setTimeout(() => recorder.stop(), seconds * 1000);
  });
}
