// Small helpers for elements and numbers.

/**
 * The element with this id; which kind it is, the page says.
 * @type {(id: string) => any}
 */
export const $ = (id) => document.getElementById(id);

/**
 * Make an element with properties and children; `aria-...`, `role` and the like are set as attributes.
 * @param {string} tag
 * @param {Record<string, any>} properties
 * @param {...(Node | string)} children
 * @returns {any}
 */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role" || name === "for" || name === "list") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** Write a number for people: `digits` significant ones, a power of ten only where it is needed. */
export function written(value, digits = 6) {
  if (value === null || value === undefined) return "none";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits)));
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  return `${Number(mantissa)}·10${superscript(Number(exponent))}`;
}

export function superscript(integer) {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  return [...String(integer)].map((c) => (c === "-" ? "⁻" : digits[Number(c)])).join("");
}

export const degrees = (radians, digits = 4) => `${written((radians * 180) / Math.PI, digits)}°`;

/** Colour of the theme by its name in style.css. */
export const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** Call `paint` now and again whenever light and dark change. */
export function onTheme(paint) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
}

export const calm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** A function that runs `work` at most once per frame. */
export function oncePerFrame(work) {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; work(); });
  };
}
