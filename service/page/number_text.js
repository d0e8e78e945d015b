// How a number of a description is read and written in a field: decimals, formulas, degrees.
import { formula } from "./formula.js";

/** What a field shows for a value, given its text in the description. */
export function shownNumber(value, source) {
  if (value === undefined || value === null) return "";
  if (typeof value === "number") return source ?? String(value);
  if (typeof value === "string") return value;
  if (typeof value === "object" && "degrees" in value) return `${typeof value.degrees === "string" ? `(${value.degrees})` : value.degrees}°`;
  if (typeof value === "object" && "unit" in value) return `${value.value} ${value.unit}`;
  return JSON.stringify(value);
}

/** Whether a text is JSON. */
function isJson(text) {
  try {
    JSON.parse(text);
    return true;
  } catch {
    return false;
  }
}

const DECIMAL = /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/;

/** A decimal as JSON has it. */
const asJson = (text) => text.replace(/^\+/, "").replace(/^(-?)\./, "$10.").replace(/\.(?=$|[eE])/, "").replace(/^(-?)0+(?=\d)/, "$1");

/**
 * The JSON of what was typed: `{source}`, or `{problem}` in words. `names` are those of `let`; with `open` any formula is left to the
 * service, which knows the names of times and places.
 */
export function typedNumber(text, { names = {}, angle = false, open = false } = {}) {
  const typed = text.trim().replace(/−/g, "-");
  if (DECIMAL.test(typed)) return { source: asJson(typed) };
  const turned = /^\(?(.+?)\)?\s*(?:°|deg|degrees)$/.exec(typed);
  if (angle && turned) return { source: `{"degrees": ${DECIMAL.test(turned[1].trim()) ? asJson(turned[1].trim()) : JSON.stringify(turned[1].trim())}}` };
  if (open && typed.startsWith("{")) return isJson(typed) ? { source: typed } : { problem: "This is no JSON: a brace or a quotation mark is missing" };
  if (/^[-+]?\d+,\d+$/.test(typed)) return { problem: `Decimals have a point here: ${typed.replace(",", ".")}` };
  if (!open && !Number.isFinite(formula(typed, names))) return { problem: "A number or a formula such as sqrt(2)/2, please" };
  return { source: JSON.stringify(typed) };
}
