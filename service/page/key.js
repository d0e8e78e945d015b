// The key of a service that requires one: entered once, then stored as long as the tab is open.
import { make } from "./dom.js";

const NAME = "polhode-key";
let waiting = null;

export const storedKey = () => sessionStorage.getItem(NAME);

/** Show a field for the key until one is entered; `refused` is the key that the service did not accept. */
export function keyFromReader(refused) {
  // Another request has had its answer already, or waits for the same field.
  if (storedKey() !== refused) return Promise.resolve();
  waiting ??= new Promise((entered) => {
    const field = make("input", { type: "password", autocomplete: "off", required: true });
    const said = refused ? "The service does not accept this key. Another one:" : "This service requires a key:";
    const form = make("form", { className: "credentials", "aria-label": "Key" }, make("label", {}, `${said} `, field), " ", make("button", { textContent: "Use" }));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      sessionStorage.setItem(NAME, field.value.trim());
      form.remove();
      waiting = null;
      entered();
    });
    document.querySelector("header").after(form);
    field.focus();
  });
  return waiting;
}
