// Fields for numbers, with their errors in words beside them.
import { make } from "./dom.js";

/** Three fields for the components of a vector; `onChange` gets the numbers once all of them are numbers. */
export class VectorFields {
  constructor(panel, names, describedBy, onChange) {
    this.inputs = names.map((name) => {
      const input = make("input", { inputMode: "decimal", autocomplete: "off", "aria-describedby": describedBy });
      panel.append(make("label", {}, name, input));
      input.addEventListener("change", () => {
        const values = this.inputs.map((i) => numberOf(i.value));
        this.inputs.forEach((i, k) => mark(i, values[k] === null));
        if (values.every((v) => v !== null)) onChange(values);
        else onChange(null);
      });
      return input;
    });
  }

  set(values, digits = 17) {
    this.inputs.forEach((input, k) => {
      input.value = String(Number(values[k].toPrecision(digits)));
      mark(input, false);
    });
  }

  mark(wrong) {
    for (const input of this.inputs) mark(input, wrong);
  }
}

/** The number that a text is, or null. */
export function numberOf(text) {
  const value = text.trim() === "" ? NaN : Number(text.trim());
  return Number.isFinite(value) ? value : null;
}

export function mark(input, wrong) {
  if (wrong) input.setAttribute("aria-invalid", "true");
  else input.removeAttribute("aria-invalid");
}
