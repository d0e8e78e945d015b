// The reference: swagger-ui over the OpenAPI document of the service that serves this page.
"use strict";

// Its links to operations stand inside buttons, which keyboards and screen readers cannot tell apart: plain text instead.
const plainNames = ({ React }) => ({ components: { DeepLink: ({ text }) => React.createElement("span", {}, text) } });

// What the viewer leaves unnamed, out of reach of the keyboard or at the wrong level.
const MISSING = {
  "h3.opblock-tag": { "aria-level": "2" },
  "#reference h4": { "aria-level": "3" },
  "#reference h5": { "aria-level": "4" },
  "#servers": { "aria-label": "Server" },
  "#reference select": { "aria-label": "Choice" },
  "#reference textarea": { "aria-label": "Request body" },
  "#reference pre": { tabindex: "0" },
  ".information-container": { role: "region", "aria-label": "About the service" },
  ".scheme-container": { role: "region", "aria-label": "Server and key" },
  ".filter-container": { role: "search" },
};

function mend() {
  for (const [selector, attributes] of Object.entries(MISSING)) {
    for (const element of document.querySelectorAll(selector)) {
      for (const [name, value] of Object.entries(attributes)) if (!element.hasAttribute(name)) element.setAttribute(name, value);
    }
  }
}
new MutationObserver(mend).observe(document.getElementById("reference"), { childList: true, subtree: true });

window.SwaggerUIBundle({
  url: "/openapi.json",
  dom_id: "#reference",
  deepLinking: true,
  plugins: [plainNames],
  docExpansion: "list",
  defaultModelsExpandDepth: 0,
  displayRequestDuration: true,
  filter: true,
  tryItOutEnabled: true,
  validatorUrl: null,
  onComplete: () => { mend(); document.body.dataset.ready = "yes"; },
});

// The viewer goes dark by a class on the document.
const dark = matchMedia("(prefers-color-scheme: dark)");
const follow = () => document.documentElement.classList.toggle("dark-mode", dark.matches);
dark.addEventListener("change", follow);
follow();
