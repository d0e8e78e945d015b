// The request behind a picture, as JSON, curl and Python, to be copied.
import { make } from "./dom.js";

/** JSON with arrays of numbers on one line. */
export const readable = (value) =>
  JSON.stringify(value, null, 2).replace(/\[[^[\]{}"]*\]/g, (list) => list.replace(/\s+/g, " ").replace("[ ", "[").replace(" ]", "]"));

const FORMS = {
  JSON: (path, question) => readable(question),
  curl: (path, question) =>
    `curl -s ${location.origin}${path} -H 'Content-Type: application/json' -d '${JSON.stringify(question).replaceAll("'", "'\\''")}'`,
  Python: (path, question) =>
    `import json, urllib.request\n\nquestion = json.loads(r'''${JSON.stringify(question)}''')\n` +
    `request = urllib.request.Request("${location.origin}${path}", json.dumps(question).encode(), {"Content-Type": "application/json"})\n` +
    `answer = json.load(urllib.request.urlopen(request))\nprint(json.dumps(answer, indent=1)[:2000])\n`,
};

/** Fill `panel`; returns a function that takes the requests as `{label: [path, question]}`. */
export function requestPanel(panel) {
  let requests = {};
  const which = make("select", { "aria-label": "Request" });
  const form = make("select", { "aria-label": "Form" }, ...Object.keys(FORMS).map((name) => make("option", { textContent: name })));
  const copy = make("button", { type: "button", textContent: "Copy" });
  const said = make("span", { className: "soft", role: "status" });
  const text = make("pre", { tabIndex: 0, "aria-label": "Request", role: "region" });
  panel.append(make("div", { className: "row" }, which, form, copy, said), text);

  const show = () => {
    const [path, question] = requests[which.value] || ["", {}];
    text.textContent = `${form.value === "JSON" ? `POST ${path}\n` : ""}${FORMS[form.value](path, question)}`;
    said.textContent = "";
  };
  which.onchange = form.onchange = show;
  copy.onclick = async () => {
    const [path, question] = requests[which.value];
    try {
      await navigator.clipboard.writeText(FORMS[form.value](path, question));
      said.textContent = "copied";
    } catch {
      getSelection().selectAllChildren(text);
      said.textContent = "selected: copy it with Ctrl+C";
    }
  };
  return (next) => {
    requests = next;
    const names = Object.keys(next);
    if (names.join() !== [...which.options].map((o) => o.value).join()) {
      which.replaceChildren(...names.map((name) => make("option", { textContent: name, value: name })));
    }
    show();
  };
}
