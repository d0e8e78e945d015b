// Writes a drawing as SVG.

const HEAD = 10;
const escape = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const pair = (p) => p.map((x) => x.toFixed(2)).join(",");

/** The text of an SVG file of `width` times `height` pixels; arguments as those of `paint`. */
export function svgOf(items, { at, scale, inks, width, height, title }) {
  const shapes = items.map((item) => SHAPES[item.shape](item, at, scale, inks)).join("\n");
  return `<svg xmlns="http:\u002f/www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" role="img">
<title>${escape(title)}</title>
<rect width="100%" height="100%" fill="${inks.panel}"/>
<g stroke-linecap="round" stroke-linejoin="round" font-family="system-ui, sans-serif" font-size="13">
${shapes}
</g>
</svg>
`;
}

const edges = (ink, width, dash = []) => (ink ? `stroke="${ink}" stroke-width="${width}"${dash.length ? ` stroke-dasharray="${dash.join(" ")}"` : ""}` : "");
const inside = (ink, alpha) => (ink ? `fill="${ink}" fill-opacity="${alpha}"` : 'fill="none"');

const SHAPES = {
  line: ({ points, ink, width, dash, alpha }, at, scale, inks) => `<polyline points="${points.map((p) => pair(at(p))).join(" ")}" fill="none" ${edges(inks[ink], width, dash)} opacity="${alpha}"/>`,
  outline: ({ points, fill, stroke, width, alpha, fillAlpha = 1 }, at, scale, inks) => `<polygon points="${points.map((p) => pair(at(p))).join(" ")}" ${inside(fill && inks[fill], fillAlpha)} ${edges(stroke && inks[stroke], width)} opacity="${alpha}"/>`,
  disc({ center, radius, fill, stroke, width, alpha, fillAlpha = 1 }, at, scale, inks) {
    const [x, y] = at(center);
    return `<circle cx="${x.toFixed(2)}" cy="${y.toFixed(2)}" r="${Math.max(0.5, radius * scale).toFixed(2)}" ${inside(fill && inks[fill], fillAlpha)} ${edges(stroke && inks[stroke], width)} opacity="${alpha}"/>`;
  },
  arrow({ from, to, ink, alpha }, at, scale, inks) {
    const [ax, ay] = at(from), [bx, by] = at(to), length = Math.hypot(bx - ax, by - ay) || 1;
    const [ux, uy] = [(bx - ax) / length, (by - ay) / length], h = Math.min(HEAD, length);
    const head = [[bx, by], [bx - ux * h - (uy * h) / 2, by - uy * h + (ux * h) / 2], [bx - ux * h + (uy * h) / 2, by - uy * h - (ux * h) / 2]];
    return `<g opacity="${alpha}"><polyline points="${pair([ax, ay])} ${pair([bx - ux * h * 0.6, by - uy * h * 0.6])}" fill="none" ${edges(inks[ink], 3)}/><polygon points="${head.map(pair).join(" ")}" fill="${inks[ink]}"/></g>`;
  },
  words: ({ at: place, text, ink, alpha }, at, scale, inks) => `<text x="${at(place)[0].toFixed(2)}" y="${at(place)[1].toFixed(2)}" fill="${inks[ink]}" opacity="${alpha}">${escape(text)}</text>`,
};
