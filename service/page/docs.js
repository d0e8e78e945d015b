"use strict";
// Shows the OpenAPI document of the service it comes from; needs nothing from anywhere else.
const make = (tag, text, properties = {}) => Object.assign(document.createElement(tag), { textContent: text ?? "" }, properties);
const nameOf = (reference) => reference.split("/").pop();

function link(reference) {
  return make("a", nameOf(reference), { href: "#schema-" + nameOf(reference) });
}

// A schema in a few words, with links to the named ones.
function brief(schema) {
  const out = document.createElement("span");
  const several = schema.oneOf || schema.anyOf;
  if (schema.$ref) out.append(link(schema.$ref));
  else if (several) several.forEach((one, i) => out.append(i ? " or " : "", brief(one)));
  else if (schema.const !== undefined) out.append(JSON.stringify(schema.const));
  else if (schema.enum) out.append(schema.enum.map((value) => JSON.stringify(value)).join(" or "));
  else if (schema.type === "array") {
    const length = schema.minItems !== undefined && schema.minItems === schema.maxItems ? `${schema.minItems} × ` : "";
    out.append(`[${length}`, brief(schema.items || (schema.prefixItems || [{}])[0]), "]");
  } else out.append(schema.type || "anything");
  const limits = [["exclusiveMinimum", ">"], ["minimum", "≥"], ["exclusiveMaximum", "<"], ["maximum", "≤"]];
  for (const [key, sign] of limits) if (schema[key] !== undefined) out.append(` ${sign} ${schema[key]}`);
  if (schema["x-unit"] && schema["x-unit"] !== "1") out.append(" " + schema["x-unit"]);
  if (schema.default !== undefined && schema.default !== null) out.append(`, default ${JSON.stringify(schema.default)}`);
  return out;
}

function table(schema) {
  const rows = make("table");
  for (const [name, field] of Object.entries(schema.properties || {})) {
    const row = rows.insertRow();
    row.insertCell().append(make("code", name), (schema.required || []).includes(name) ? "" : " (optional)");
    row.insertCell().append(brief(field));
    row.insertCell().textContent = field.description || "";
  }
  return rows;
}

function attempt(path, example) {
  const part = document.createElement("div"), text = make("textarea", JSON.stringify(example, null, 1));
  const button = make("button", "Ask"), answer = make("pre"), note = make("span", "", { className: "soft" });
  text.spellcheck = false;
  text.setAttribute("aria-label", "question");
  answer.hidden = true;
  button.onclick = async () => {
    const response = await fetch(path, { method: "POST", headers: { "content-type": "application/json" }, body: text.value });
    const content = await response.text();
    note.textContent = ` ${response.status}, ${content.length} bytes, ${response.headers.get("server-timing")}`;
    answer.hidden = false;
    answer.textContent = content.length > 20000 ? content.slice(0, 20000) + " …" : content;
  };
  part.append(text, button, note, answer);
  return part;
}

function operation(path, verb, entry) {
  const part = document.createElement("details"), head = document.createElement("summary");
  head.append(make("span", verb.toUpperCase(), { className: "verb" }), make("code", path), " ", make("span", entry.summary, { className: "soft" }));
  part.append(head);
  if (entry.description) part.append(make("p", entry.description));
  const request = entry.requestBody?.content["application/json"];
  if (request) {
    part.append(make("p", "Question: "), brief(request.schema));
    for (const example of Object.values(request.examples || {})) {
      part.append(make("p", example.summary, { className: "soft" }), attempt(path, example.value));
    }
  }
  const rows = make("table");
  for (const [status, response] of Object.entries(entry.responses)) {
    const row = rows.insertRow(), content = Object.values(response.content || {})[0];
    row.insertCell().textContent = status;
    row.insertCell().textContent = response.description;
    if (content?.schema) row.insertCell().append(brief(content.schema));
  }
  part.append(rows);
  return part;
}

fetch("/openapi.json").then((response) => response.json()).then((api) => {
  for (const paragraph of api.info.description.split("\n\n")) document.getElementById("about").append(make("p", paragraph));
  const tags = new Map();
  for (const [path, verbs] of Object.entries(api.paths)) {
    for (const [verb, entry] of Object.entries(verbs)) {
      const tag = (entry.tags || ["other"])[0];
      if (!tags.has(tag)) tags.set(tag, []);
      tags.get(tag).push(operation(path, verb, entry));
    }
  }
  for (const [tag, entries] of tags) document.getElementById("operations").append(make("h2", tag), ...entries);
  for (const [name, schema] of Object.entries(api.components.schemas)) {
    const part = make("details", "", { id: "schema-" + name });
    part.append(make("summary", name), make("p", schema.description || ""), table(schema));
    document.getElementById("schemas").append(part);
  }
  const open = () => { const target = document.getElementById(location.hash.slice(1)); if (target) target.open = true; };
  window.onhashchange = open;
  open();
});
