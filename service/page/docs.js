// The reference: swagger-ui over the OpenAPI document of the service that serves this page.
"use strict";

// Its links to operations stand inside buttons, which keyboards and screen readers cannot tell apart: plain text instead.
const plainNames = ({ React }) => ({ components: { DeepLink: ({ text }) => React.createElement("span", {}, text) } });

// What the viewer leaves unnamed or at the wrong level.
function mend() {
  for (const heading of document.querySelectorAll("h3.opblock-tag:not([aria-level])")) heading.setAttribute("aria-level", "2");
  document.querySelector("#servers")?.setAttribute("aria-label", "Server");
  for (const select of document.querySelectorAll("#reference select:not([aria-label])")) select.setAttribute("aria-label", "Choice");
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
