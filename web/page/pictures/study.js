// What accuracy costs, drawn while it is measured: the error at the end against the time that a run took, of every method
// that the scene can be integrated by.
import { Plot } from "./plot.js";

const ofTime = (method) => `seconds of ${method}`;

export class Study {
  /** `ask` sends a message to the worker, `tell` shows a line of text. */
  constructor(section, button, ask, tell) {
    Object.assign(this, { section, button, ask, tell, asked: false });
  }

  begin(scene, settings) {
    this.asked = true;
    this.button.disabled = true;
    this.tell("Looking for what to compare with");
    this.ask({ kind: "study", scene, settings });
  }

  begun({ methods, uncertainty }) {
    this.points = new Map(methods.map((method) => [method, []]));
    this.tell(`Errors are known down to ${uncertainty.toExponential(1)}`);
  }

  /** One run more. */
  hear({ method, error, seconds }) {
    if (!this.points) return; // of a scene that is not here any more
    if (error > 0 && seconds > 0) this.points.get(method).push({ error, seconds });
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  /** Nothing is measured any more; the picture stays. */
  end() {
    this.asked = false;
    this.button.disabled = false;
  }

  draw() {
    const measured = [...(this.points ?? [])].filter(([, points]) => points.length > 0);
    if (measured.length === 0) return;
    const curves = measured.map(([method]) => method);
    if (curves.length !== this.plot?.panel.curves.length) {
      this.section.replaceChildren();
      this.plot = new Plot(this.section, {
        title: "what accuracy costs", x_label: "seconds", y_label: "error at the end", log: true, x_of: ofTime, curves });
    }
    const columns = {};
    for (const [method, points] of measured) {
      columns[method] = points.map(({ error }) => error);
      columns[ofTime(method)] = points.map(({ seconds }) => seconds);
    }
    this.plot.draw([columns]);
  }

  /** Of another scene nothing is known. */
  forget() {
    this.section.replaceChildren();
    this.plot = this.points = null;
    this.end();
  }
}
