// The reference: swagger-ui over the OpenAPI document of the service that serves this page.

// Its links to operations stand inside buttons, which keyboards and screen readers cannot tell apart: plain text instead.
const plainNames = ({ React }) => ({ components: { DeepLink: ({ text }) => React.createElement("span", {}, text) } });

/** A copy of a part of the document with what its local references name; one that contains itself stays a reference there. */
function withoutReferences(document, part, inside = []) {
  if (Array.isArray(part)) return part.map((entry) => withoutReferences(document, entry, inside));
  if (part === null || typeof part !== "object") return part;
  const { $ref: reference, ...own } = part;
  if (typeof reference === "string") {
    if (inside.includes(reference)) return part;
    const target = reference.slice(2).split("/").reduce((node, step) => node[step], document);
    return { ...withoutReferences(document, target, [...inside, reference]), ...withoutReferences(document, own, inside) };
  }
  return Object.fromEntries(Object.entries(part).map(([name, value]) => [name, withoutReferences(document, value, inside)]));
}

// The viewer's own resolver first takes in the whole document, for more than a second, whichever part is to be shown.
const partsResolved = () => ({
  fn: {
    resolveSubtree: async (document, path) => ({
      spec: withoutReferences(document, path.reduce((node, step) => node?.[step], document)),
      errors: [],
    }),
  },
});

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

// Read here: the viewer would read it as YAML.
const spec = await (await fetch("/openapi.json")).json();
/** @type {any} */ (window).SwaggerUIBundle({
  spec,
  dom_id: "#reference",
  deepLinking: true,
  plugins: [plainNames, partsResolved],
  docExpansion: "list",
  // Each operation shows its schemas; a list of all of them takes as long as the rest of the page.
  defaultModelsExpandDepth: -1,
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
