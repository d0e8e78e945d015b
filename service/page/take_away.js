// What can be taken away of a scene: its link, a file of it, pictures, a table, a film, a sheet to print, a frame for another page.
import { $, make } from "./dom.js";
import { exerciseLink } from "./exercise.js";
import { notebookOf } from "./notebook.js";

const FRAMES = 30;
/** Of a film, in a second. */

/** Offer a file. */
function download(name, content, type) {
  const place = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  make("a", { href: place, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(place), 10_000);
}

/** A table of all columns as CSV: units in the heads, vectors by component, every digit. */
export function csvOf({ time, columns }) {
  const heads = ["time (s)"], data = [time];
  for (const [name, { unit, values }] of Object.entries(columns)) {
    const of = unit === "1" ? "" : ` (${unit})`;
    if (!Array.isArray(values[0])) { heads.push(name + of); data.push(values); continue; }
    const axes = values[0].length === 4 ? "wxyz" : "xyz";
    values[0].forEach((_, k) => { heads.push(`${name}.${axes[k]}${of}`); data.push(values.map((v) => v?.[k] ?? null)); });
  }
  return [heads.join(","), ...time.map((_, i) => data.map((column) => column[i] ?? "").join(","))].join("\r\n");
}

/** Record the motion from its start to its end, as it is played. */
async function film(player, canvas, say) {
  const type = ["video/webm;codecs=vp9", "video/webm"].find((t) => globalThis.MediaRecorder?.isTypeSupported(t));
  if (!type) return say("This browser cannot record films.");
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES), { mimeType: type }), pieces = [];
  recorder.ondataavailable = ({ data }) => pieces.push(data);
  const done = new Promise((resolve) => { recorder.onstop = resolve; });
  player.pause();
  player.seek(0);
  recorder.start();
  say("Recording: the motion plays once.");
  await player.once();
  recorder.stop();
  await done;
  say("The film is recorded.");
  return new Blob(pieces, { type: "video/webm" });
}

/** Wire the buttons; `page` has `name()`, `title()`, `text()`, `request()` as path and question, `trajectory()`, `canvas()`, `svg()` or null, `player`, `say`. */
export function takeAway(page) {
  const on = (id, act) => { $(id).onclick = async () => { const problem = await act(); if (problem) page.say(problem); }; };
  const copied = async (text, what) => {
    try {
      await navigator.clipboard.writeText(text);
      page.say(`${what} copied.`);
    } catch {
      page.say(`${what}: ${text}`);
    }
  };
  on("take-link", () => copied(location.href, "The link"));
  on("take-frame", () => copied(`<iframe src="${location.href.replace("/scenes#", "/scenes?embed=1#")}" width="720" height="600" title="${page.title().replaceAll('"', "'")}"></iframe>`, "The frame for another page"));
  on("take-exercise", () => copied(exerciseLink(location.href, $("exercise-figure").value), "The link to the exercise"));
  on("take-json", () => download(`${page.name()}.json`, page.text(), "application/json"));
  on("take-png", () => new Promise((done) => { page.render(); page.canvas().toBlob((blob) => { if (blob) download(`${page.name()}.png`, blob); done(blob ? null : "The picture cannot be read."); }); }));
  on("take-svg", () => { const svg = page.svg(); if (svg) download(`${page.name()}.svg`, svg, "image/svg+xml"); return svg ? null : "Scenes in space have no SVG; take the PNG."; });
  on("take-csv", () => { const trajectory = page.trajectory(); if (trajectory) download(`${page.name()}.csv`, csvOf(trajectory), "text/csv"); return trajectory ? null : "There is no motion to tabulate."; });
  on("take-notebook", () => {
    const [path, scene] = page.request();
    download(`${page.name()}.ipynb`, JSON.stringify(notebookOf(page.title(), location.origin, path, scene), null, 1), "application/x-ipynb+json");
  });
  on("take-film", async () => { const blob = await film(page.player, page.canvas(), page.say); if (blob) download(`${page.name()}.webm`, blob); });
  on("take-print", () => { print(); });
}
