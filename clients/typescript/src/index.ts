export { Polhode } from "./client.js";
export type { Settings, StudyState } from "./client.js";
export type { Options, Progress } from "./exchange.js";
export { Refused } from "./refused.js";
export type { Problem } from "./refused.js";
export type { components, operations, paths } from "./schema.js";
