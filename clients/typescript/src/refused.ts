import type { components } from "./schema.js";

/** A problem of the service (RFC 9457). */
export type Problem = components["schemas"]["ProblemDocument"];

/** The service answered with a problem. */
export class Refused extends Error {
  /** HTTP status. */
  readonly status: number;
  /** Stable; GET /v1/errors lists them all. "unknown" for a reply that is no problem of the service. */
  readonly code: string;
  /** Places of the question, what must hold there and, where there is one, the remedy. */
  readonly errors: NonNullable<Problem["errors"]>;
  /** When the request may be sent again (s). */
  readonly retryAfter: number | undefined;

  constructor(status: number, problem: Partial<Problem>, retryAfter?: number) {
    super(problem.detail ?? `status ${status} without a problem of the service`);
    this.name = "Refused";
    this.status = status;
    this.code = problem.code ?? "unknown";
    this.errors = problem.errors ?? [];
    this.retryAfter = retryAfter;
  }

  /** Returns the refusal that a response says. */
  static async read(response: Response, retryAfter?: number): Promise<Refused> {
    const found: unknown = await response.json().catch(() => ({}));
    const isProblem = typeof found === "object" && found !== null && "code" in found;
    return new Refused(response.status, isProblem ? (found as Problem) : {}, retryAfter);
  }
}
