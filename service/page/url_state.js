// The state of a page in the fragment of its address, so that a picture can be linked to.

export const readState = () => Object.fromEntries(new URLSearchParams(location.hash.slice(1)));

/** Write `state`, without what is null; neither history nor scroll position change. */
export function writeState(state) {
  const entries = Object.entries(state).filter(([, value]) => value !== null && value !== undefined && value !== "");
  const text = entries.map(([name, value]) => `${name}=${encodeURIComponent(value).replaceAll("%2C", ",").replaceAll("%3B", ";")}`);
  history.replaceState(null, "", `#${text.join("&")}`);
}
