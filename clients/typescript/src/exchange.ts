/** A request before it is sent. */
export interface Asked {
  readonly method: "GET" | "POST" | "DELETE";
  readonly path: string;
  /** Media type of the answer. */
  readonly media: string;
  /** What fills the braces of the path. */
  readonly places?: Readonly<Record<string, string>>;
  readonly query?: Readonly<Record<string, string | number | undefined>>;
  readonly question?: unknown;
  /** Whether it begins something that a repeated request must not begin again. */
  readonly once?: boolean;
}

/** What is reported while a request takes longer than a second. */
export interface Progress {
  readonly path: string;
  /** Since the request was sent (s). */
  readonly elapsed: number;
  /** Whether this is the last report. */
  readonly done: boolean;
}

/** Settings of one request; those that are left out are the client's. */
export interface Options {
  /** From sending a request to the end of its answer (s). */
  readonly timeout?: number;
  /** How long to wait, in all, until a busy service may be sent a request again (s). */
  readonly patience?: number;
  readonly progress?: (progress: Progress) => void;
  /** Ends the request; the service stops what nobody waits for. */
  readonly signal?: AbortSignal;
}

const FIRST_REPORT = 1000;
const EVERY = 250;

/** Calls `report` every quarter of a second from the first second on, until the returned function is called. */
export function reporting(report: ((progress: Progress) => void) | undefined, path: string): () => void {
  if (report === undefined) return () => undefined;
  const since = Date.now();
  let reported = false;
  const tell = (done: boolean): void => report({ path, elapsed: (Date.now() - since) / 1000, done });
  const timer = setInterval(() => {
    if (Date.now() - since < FIRST_REPORT) return;
    reported = true;
    tell(false);
  }, EVERY);
  return () => {
    clearInterval(timer);
    if (reported) tell(true);
  };
}

/** Returns the address of a request below that of the service. */
export function addressOf(url: string, { path, places = {}, query = {} }: Asked): string {
  const filled = path.replace(/{(\w+)}/g, (_, name: string) => encodeURIComponent(places[name] ?? ""));
  const given = Object.entries(query).flatMap(([name, value]) => (value === undefined ? [] : [[name, String(value)]]));
  return url.replace(/\/$/, "") + filled + (given.length > 0 ? `?${new URLSearchParams(given)}` : "");
}

/** Returns how long a Retry-After header says to wait (s): seconds, or a date (RFC 9110, 10.2.3). */
export function secondsOf(header: string | null): number | undefined {
  if (header === null) return undefined;
  const seconds = /^\d+$/.test(header) ? Number(header) : (Date.parse(header) - Date.now()) / 1000;
  return Number.isNaN(seconds) ? undefined : Math.max(0, seconds);
}

/** Resolves after some seconds, or rejects when the signal is aborted. */
export function pause(seconds: number, signal?: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    signal?.throwIfAborted();
    const ended = (): void => {
      clearTimeout(timer);
      reject(signal?.reason);
    };
    const timer = setTimeout(() => {
      signal?.removeEventListener("abort", ended);
      resolve();
    }, 1000 * seconds);
    signal?.addEventListener("abort", ended, { once: true });
  });
}
