// Speed against accuracy: a named method with one setting, run beside the closed form.
import { Refusal, Worker, get } from "./api.js";
import { $, make, written } from "./dom.js";
import { tradeChart } from "./plots.js";
import { power, tradeInWords } from "./words.js";

const NAMES = {
  "closed-form": "Exact (closed form)", "explicit-euler": "Explicit Euler", "runge-kutta-4": "Runge-Kutta 4", "implicit-midpoint": "Implicit midpoint",
  "symmetric-splitting": "Symmetric splitting", "discrete-moser-veselov": "Discrete Moser-Veselov", "dormand-prince-853": "Dormand-Prince 8(5,3)", lsoda: "LSODA", radau: "Radau",
};

export class Integrator {
  /** `onRun(samples or null)` shows what the method makes of the motion, `onState` tells that the choice has changed. */
  constructor(onRun, onState) {
    this.onRun = onRun;
    this.onState = onState;
    this.kind = "closed-form";
    /** @type {number | null} */
    this.setting = null;
    /** @type {Map<string, any>} */
    this.methods = new Map();
    /** @type {any} */
    this.question = null;
    this.worker = new Worker($("progress"));
    $("method").onchange = () => this.choose($("method").value, null);
    $("setting").oninput = () => {
      this.setting = this.settingOf(Number($("setting").value));
      this.onState();
      this.showSetting();
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.run(), 60);
    };
  }

  async load() {
    const { methods } = await get("/v1/methods");
    for (const method of methods) this.methods.set(method.kind, method);
    $("method").replaceChildren(...methods.map((m) => make("option", { value: m.kind, textContent: NAMES[m.kind] || m.kind })));
  }

  choose(kind, setting) {
    this.kind = this.methods.has(kind) ? kind : "closed-form";
    this.setting = setting;
    $("method").value = this.kind;
    const method = this.methods.get(this.kind);
    $("method-use").textContent = method.when_to_use;
    $("setting-fields").hidden = !method.setting;
    $("setting-name").textContent = method.setting === "step" ? "Step (s): fast on the left, accurate on the right" : "Tolerance: fast on the left, accurate on the right";
    this.onState();
    if (this.question) this.follow(this.question);
  }

  /** Exponents of ten between which the slider moves. */
  range() {
    if (this.methods.get(this.kind).setting === "tolerance") return [-2, -14];
    const rate = Math.log10(Math.hypot(...this.question.angular_velocity) || 1);
    return [-0.3 - rate, -4 - rate];
  }

  settingOf(position) {
    const [low, high] = this.range();
    return Number((10 ** (low + ((high - low) * position) / 100)).toPrecision(3));
  }

  showSetting() {
    const [low, high] = this.range();
    $("setting").value = (100 * (Math.log10(this.setting) - low)) / (high - low);
    $("setting-shown").textContent = written(this.setting, 3);
    $("setting").setAttribute("aria-valuetext", written(this.setting, 3));
  }

  get method() {
    const { setting } = this.methods.get(this.kind);
    return setting ? { kind: this.kind, [setting]: this.setting } : null;
  }

  /** Run the method on the motion of `question` (without attitude). */
  follow(question) {
    this.question = question;
    if (!this.methods.get(this.kind)?.setting) {
      this.points = null;
      this.onRun(null);
      return;
    }
    this.setting ??= this.settingOf(35);
    this.showSetting();
    this.points = null;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.run(), 60);
  }

  async run() {
    if (!this.method) return;
    $("setting-fields").setAttribute("aria-busy", "true");
    const question = { ...this.question, method: this.method };
    try {
      await this.worker.run(async (send) => {
        const { answer, milliseconds } = await send("/v1/rotation/trajectory", question);
        $("trade").textContent = tradeInWords(answer, milliseconds);
        this.onRun(answer);
        this.points ??= await this.ladder(send);
        tradeChart($("trade-chart"), this.points, [answer.work.evaluations, answer.accuracy.error]);
        $("trade-chart").setAttribute("aria-label", `Error against evaluations: ${this.points.map(([n, e]) => `${n} evaluations, ${power(e)}`).join("; ")}`);
      });
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      $("trade").textContent = `The method fails here: ${error.errors[0].detail}.`;
      this.onRun(null);
    } finally {
      if (!this.worker.running) $("setting-fields").setAttribute("aria-busy", "false");
    }
  }

  /** Errors and evaluations of the method at settings over the whole slider. */
  async ladder(send) {
    const { setting } = this.methods.get(this.kind);
    const methods = [10, 25, 40, 55, 70, 85].map((position) => ({ kind: this.kind, [setting]: this.settingOf(position) }));
    const { answer } = await send("/v1/work-precision", { ...this.question, methods });
    return answer.curves.flatMap((curve) => curve.measurements).filter((m) => m.error).map((m) => [m.evaluations, m.error]);
  }
}
