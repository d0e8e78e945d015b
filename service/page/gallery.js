// The catalogue as a gallery: topics, small pictures, titles, the question of each scene; a search over all its words.
import { $, make } from "./dom.js";
import { isNamed } from "./named_scenes.js";
import { drawThumbnail } from "./thumbnail.js";

const WIDTH = 168, HEIGHT = 112;
/** Pixels of a small picture. */

export class Gallery {
  /** `choose(name)` opens a scene. */
  constructor(choose) {
    this.choose = choose;
    this.dialog = $("gallery");
    this.search = $("gallery-search");
    this.search.oninput = () => this.filter();
    $("gallery-close").onclick = () => this.dialog.close();
    this.watch = new IntersectionObserver((entries) => { for (const { isIntersecting, target } of entries) if (isIntersecting) this.picture(target); });
  }

  /** Take the scenes of the catalogue. */
  fill(scenes) {
    this.cards = scenes.map((scene) => this.card(scene));
    // Scenes that cannot be built upon come last.
    const topics = Map.groupBy([...this.cards].sort((p, q) => Number(isNamed(p.scene.name)) - Number(isNamed(q.scene.name))), ({ scene }) => scene.topic);
    this.sections = [...topics].map(([topic, cards]) => {
      const section = make("section", { "aria-label": topic }, make("h3", { textContent: topic }), make("ul", { className: "cards" }, ...cards.map(({ item }) => item)));
      return { section, cards };
    });
    $("gallery-topics").replaceChildren(...this.sections.map(({ section }) => section));
  }

  card(scene) {
    const canvas = make("canvas", { width: WIDTH, height: HEIGHT, "aria-hidden": "true" });
    const button = make("button", { type: "button", className: "card" }, canvas, make("strong", { textContent: scene.title }), make("span", { textContent: scene.asks ?? `${scene.summary}.` }));
    button.title = `${scene.summary}.`;
    button.onclick = () => { this.dialog.close(); this.choose(scene.name); };
    canvas.dataset.scene = scene.name;
    return { scene, canvas, item: make("li", {}, button), words: [scene.title, scene.summary, scene.asks, scene.topic, scene.name].join(" ").toLowerCase() };
  }

  open() {
    this.dialog.showModal();
    this.search.value = "";
    this.filter();
    this.search.focus();
    for (const { canvas } of this.cards) this.watch.observe(canvas);
  }

  picture(canvas) {
    this.watch.unobserve(canvas);
    const { scene } = this.cards.find((card) => card.canvas === canvas);
    if (isNamed(scene.name)) return;
    drawThumbnail(canvas, scene.example, WIDTH, HEIGHT);
  }

  /** Show the scenes in which every word that was typed occurs. */
  filter() {
    const typed = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const { section, cards } of this.sections) {
      for (const { item, words } of cards) {
        item.hidden = !typed.every((word) => words.includes(word));
        if (!item.hidden) count++;
      }
      section.hidden = cards.every(({ item }) => item.hidden);
    }
    $("gallery-count").textContent = `${count} scene${count === 1 ? "" : "s"}`;
  }
}
