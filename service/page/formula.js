// Numbers of a described scene: decimals, formulas over named numbers, angles in degrees, polar vectors.

const OWN = ["sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "abs"];
const FUNCTIONS = Object.fromEntries(OWN.map((name) => [name, Math[name]]));
Object.assign(FUNCTIONS, { arcsin: Math.asin, arccos: Math.acos, arctan: Math.atan, ln: Math.log });

/** Value of a formula such as `"2*cos(pi/6)"`; NaN where it is none, which the service then refuses. */
export function formula(text, names = {}) {
  const tokens = text.match(/\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+|[A-Za-z_]\w*|\*\*|[-+*/^()]|\S/g) || [];
  let at = 0;
  const sum = () => {
    let value = product();
    while (tokens[at] === "+" || tokens[at] === "-") value = tokens[at++] === "+" ? value + product() : value - product();
    return value;
  };
  const product = () => {
    let value = factor();
    while (tokens[at] === "*" || tokens[at] === "/") value = tokens[at++] === "*" ? value * factor() : value / factor();
    return value;
  };
  const factor = () => {
    if (tokens[at] === "-" || tokens[at] === "+") return tokens[at++] === "-" ? -factor() : factor();
    const base = atom();
    if (tokens[at] !== "^" && tokens[at] !== "**") return base;
    at++;
    return base ** factor();
  };
  const atom = () => {
    const token = tokens[at++];
    if (token === "(" || Object.hasOwn(FUNCTIONS, token ?? "")) {
      if (token !== "(" && tokens[at++] !== "(") return NaN;
      const value = sum();
      if (tokens[at++] !== ")") return NaN;
      return token === "(" ? value : FUNCTIONS[token](value);
    }
    if (token === "pi") return Math.PI;
    if (token !== undefined && Object.hasOwn(names, token)) return names[token];
    return token === undefined ? NaN : Number(token);
  };
  const value = sum();
  return at === tokens.length ? value : NaN;
}

/** Reads the numbers of one description; `let` names some of them. */
export class Numbers {
  constructor(named = {}) {
    this.names = {};
    for (const [name, value] of Object.entries(named)) this.names[name] = this.number(value);
  }

  /** `more` are names beside those of the description, such as the time. */
  number(value, more = null) {
    if (typeof value === "number") return value;
    if (typeof value === "string") return formula(value, more ? { ...this.names, ...more } : this.names);
    if (value && typeof value === "object" && "degrees" in value) return (this.number(value.degrees) * Math.PI) / 180;
    if (value && typeof value === "object" && "unit" in value) return this.number(value.value);
    return NaN;
  }

  vector(value, more = null) {
    if (Array.isArray(value)) return value.map((x) => this.number(x, more));
    if (value?.polar) {
      const [r, angle] = value.polar.map((x) => this.number(x));
      return [r * Math.cos(angle), r * Math.sin(angle)];
    }
    return null;
  }
}
