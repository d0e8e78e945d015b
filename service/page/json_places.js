// JSON text with the place of every value in it, so that a value can be changed or shown without touching the rest.

/** A text that is not JSON; `offset` is where. */
export class NotJson extends Error {
  constructor(message, offset) {
    super(message);
    this.offset = offset;
  }
}

/** Return `{value, places}`: places maps JSON pointers to `[start, end]` in the text. Numbers in `value` are doubles. */
export function readJson(text) {
  const places = new Map();
  let at = 0;
  const fail = (what) => { throw new NotJson(what, at); };
  const skip = () => { while (at < text.length && " \t\r\n".includes(text[at])) at++; };
  const token = (pattern) => {
    pattern.lastIndex = at;
    const found = pattern.exec(text);
    if (found) at += found[0].length;
    return found?.[0];
  };

  function string() {
    const found = token(/"(?:[^"\\\u0000-\u001f]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*"/y);
    return found === undefined ? fail("a closing quotation mark is missing") : JSON.parse(found);
  }

  function list(pointer) {
    const items = [];
    at++;
    skip();
    if (text[at] === "]") { at++; return items; }
    for (;;) {
      items.push(read(`${pointer}/${items.length}`));
      skip();
      if (text[at] === "]") { at++; return items; }
      if (text[at] !== ",") fail("a comma or ] is missing");
      at++;
    }
  }

  function object(pointer) {
    const members = {};
    at++;
    skip();
    if (text[at] === "}") { at++; return members; }
    for (;;) {
      skip();
      if (text[at] !== '"') fail("a name in quotation marks is missing");
      const name = string();
      skip();
      if (text[at] !== ":") fail("a colon is missing");
      at++;
      members[name] = read(`${pointer}/${name.replaceAll("~", "~0").replaceAll("/", "~1")}`);
      skip();
      if (text[at] === "}") { at++; return members; }
      if (text[at] !== ",") fail("a comma or } is missing");
      at++;
    }
  }

  function read(pointer) {
    skip();
    const start = at;
    let value;
    if (text[at] === "{") value = object(pointer);
    else if (text[at] === "[") value = list(pointer);
    else if (text[at] === '"') value = string();
    else {
      const word = token(/true|false|null|-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?/y);
      value = word === undefined ? fail("a value is missing") : JSON.parse(word);
    }
    places.set(pointer, [start, at]);
    return value;
  }

  const value = read("");
  skip();
  if (at < text.length) fail("nothing may follow the closing bracket");
  return { value, places };
}

/** The place of a pointer, or of the nearest thing around it. */
export function placeOf(places, pointer) {
  for (let p = pointer; ; p = p.slice(0, p.lastIndexOf("/"))) {
    if (places.has(p)) return places.get(p);
    if (!p.includes("/")) return places.get("") || [0, 0];
  }
}
