// The playhead: play, pause, scrub. Everything that shows a time listens to it.
import { calm, make, written } from "./dom.js";

export class Player {
  /** `panel` receives the controls. */
  constructor(panel) {
    this.time = 0;
    this.stop = 1;
    this.speed = 1;
    this.playing = false;
    this.listeners = [];
    this.button = make("button", { type: "button", className: "play" });
    this.slider = make("input", { type: "range", min: 0, max: 1000, step: "any", value: 0, "aria-label": "Time" });
    this.shown = make("output", {});
    this.marks = make("div", { className: "marks", "aria-hidden": "true" });
    this.rate = make("select", { "aria-label": "Speed of play" });
    for (const factor of [0.1, 0.25, 0.5, 1, 2, 5]) {
      this.rate.append(make("option", { value: factor, textContent: `${factor} ×`, selected: factor === 1 }));
    }
    this.events = [];
    this.ahead = make("button", { type: "button", textContent: "Next event", hidden: true });
    this.ahead.onclick = () => this.next();
    panel.append(this.button, this.ahead, make("div", { className: "track" }, this.slider, this.marks), this.shown, this.rate);
    this.button.onclick = () => (this.playing ? this.pause() : this.play());
    this.slider.oninput = () => this.seek((this.slider.value / 1000) * this.stop);
    this.rate.onchange = () => { this.factor = Number(this.rate.value); };
    this.factor = 1;
    this.label();
  }

  /** Play from 0 to `stop` (s of motion) in about `seconds` (s of the clock); `events` are marked. */
  setSpan(stop, seconds, events = []) {
    this.stop = stop;
    this.events = events.filter((e) => e.time !== null && e.time <= stop);
    this.ahead.hidden = this.events.length === 0;
    this.speed = stop / seconds;
    this.time = Math.min(this.time, stop);
    this.marks.replaceChildren(
      ...this.events.map((e) => {
        const mark = make("span", { title: `${e.label}, ${written(e.time)} s` });
        mark.style.left = `${(100 * e.time) / stop}%`;
        return mark;
      }),
    );
    this.show();
  }

  onTime(listener) {
    this.listeners.push(listener);
  }

  seek(time) {
    this.time = Math.max(0, Math.min(this.stop, time));
    this.show();
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.stop) this.time = 0;
    this.playing = true;
    this.label();
    let last = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      const elapsed = Math.min(0.1, (now - last) / 1000);
      last = now;
      this.time += elapsed * this.speed * this.factor;
      if (this.time >= this.stop) this.time = 0;
      this.show();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** Play from the time shown to the end, once; resolves there. */
  once() {
    return new Promise((done) => {
      let before = this.time;
      const ended = (time) => {
        if (!this.playing || time < before) {
          this.listeners.splice(this.listeners.indexOf(ended), 1);
          this.pause();
          done();
        }
        before = time;
      };
      this.play();
      this.listeners.push(ended);
    });
  }

  /** Go to the first of the marked events after the time shown. */
  next() {
    const later = this.events.filter(({ time }) => time > this.time + 1e-9 * this.stop);
    this.pause();
    this.seek(later[0]?.time ?? this.stop);
    return later[0] ?? null;
  }

  /** Begin by itself, unless the reader prefers less motion. */
  begin() {
    if (!calm()) this.play();
  }

  pause() {
    this.playing = false;
    this.label();
  }

  label() {
    this.button.textContent = this.playing ? "Pause" : "Play";
  }

  show() {
    this.slider.value = (1000 * this.time) / this.stop;
    const text = `${written(this.time, 4)} of ${written(this.stop, 4)} s`;
    this.shown.textContent = text;
    this.slider.setAttribute("aria-valuetext", text);
    for (const listener of this.listeners) listener(this.time);
  }
}
