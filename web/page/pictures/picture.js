// The bodies of a run in space, by the stage of the page that shows finished runs, as far as the run has come.
import { Stage } from "../../../app/viewer/bodies.js";
import { rowAt } from "../../../app/viewer/frames.js";

export class Picture {
  /** `took` hears how many ms each frame has cost. */
  constructor(section, button, took) {
    this.section = section;
    this.button = button;
    this.took = took;
    this.stage = null;
    this.run = null;
    button.addEventListener("click", () => (this.stage ? this.end() : this.begin()));
  }

  /** A run that can be shown, {columns, summary}; null while it is computed. */
  offer(held) {
    const isMoving = this.stage !== null;
    this.end();
    this.run = held && held.summary.picture.shapes.length && held.columns.t.length > 1 ? held : null;
    this.section.hidden = !this.run;
    if (isMoving && this.run) this.begin(); // rows that came after somebody had asked for it
  }

  /** Throws where there is nothing to be moved. */
  begin() {
    if (this.stage) return;
    if (!this.run) throw new Error("nothing moves here until a run with bodies rests");
    const { columns, summary } = this.run;
    const run = { shapes: summary.picture.shapes, columns: { ...columns }, time: Array.from(columns.t) };
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("aria-label", "the bodies, moving");
    this.section.append(this.canvas);
    try {
      this.stage = new Stage(this.canvas, run);
    } catch (error) {
      this.canvas.remove();
      this.button.textContent = `No picture in space: ${error.message}`;
      return;
    }
    this.button.textContent = "Stop";
    const [first, last] = [run.time[0], run.time[run.time.length - 1]];
    const begun = performance.now();
    const frame = (now) => {
      if (!this.stage) return;
      const share = ((now - begun) / 20000) % 1;
      const from = performance.now();
      this.stage.draw(rowAt(run.time, first + share * (last - first)));
      this.took(performance.now() - from);
      this.frame = requestAnimationFrame(frame);
    };
    this.frame = requestAnimationFrame(frame);
  }

  end() {
    if (!this.stage) return;
    cancelAnimationFrame(this.frame);
    this.stage.renderer.dispose();
    this.stage.renderer.forceContextLoss();
    this.stage = null;
    this.canvas.remove();
    this.button.textContent = "Animate";
  }
}
