// Writes src/schema.ts, the types of everything that is sent and answered, and src/operations.ts, a method for every
// operation, from the OpenAPI document. Both are part of the package, and not of the repository.

import { existsSync, readFileSync, writeFileSync } from "node:fs";
import openapiTS, { astToString } from "openapi-typescript";

const source = ["./openapi.json", "../../docs/openapi.json"]
  .map((place) => new URL(place, import.meta.url))
  .find((place) => existsSync(place));
const document = JSON.parse(readFileSync(source, "utf-8"));
const head = "// Written by generate.mjs from the OpenAPI document; do not edit.\n\n";

const schema = await openapiTS(document, { defaultNonNullable: false });
writeFileSync(new URL("./src/schema.ts", import.meta.url), head + astToString(schema));

const TEXT = /^(text\/|image\/svg)/;
const methods = [];
for (const [path, verbs] of Object.entries(document.paths)) {
  for (const [method, operation] of Object.entries(verbs)) {
    const name = operation.operationId;
    const status = ["200", "202"].find((each) => each in operation.responses);
    const [media] = Object.keys(operation.responses[status].content);
    const json = media === "application/json";
    const answer = json ? `Content<"${name}", ${status}>` : TEXT.test(media) ? "string" : "Uint8Array";
    const own = (operation.parameters ?? []).filter((one) => !("$ref" in one));
    const places = own.filter((one) => one.in === "path").map((one) => one.name);
    const given = places.map((place) => `${place}: string`);
    const parts = [`method: "${method.toUpperCase()}"`, `path: "${path}"`, `media: "${media}"`];
    if (places.length > 0) parts.push(`places: { ${places.join(", ")} }`);
    if ("requestBody" in operation) {
      given.push(`question: Question<"${name}">`);
      parts.push("question");
    }
    if (own.some((one) => one.in === "query")) {
      given.push(`query: Query<"${name}"> = {}`);
      parts.push("query");
    }
    // A study is not begun twice by a request that is repeated.
    if (status === "202") parts.push("once: true");
    given.push("options: Options = {}");
    methods.push(
      `  /** ${operation.summary}. */\n  ${name}(${given.join(", ")}): Promise<${answer}> {\n` +
        `    return this.ask<${answer}>({ ${parts.join(", ")} }, options);\n  }\n`,
    );
  }
}

const operations = `import type { operations } from "./schema.js";
import type { Asked, Options } from "./exchange.js";

type Content<Name extends keyof operations, Status extends number> = operations[Name] extends {
  responses: { [key in Status]: { content: { "application/json": infer Answer } } };
}
  ? Answer
  : never;
type Question<Name extends keyof operations> = operations[Name] extends {
  requestBody: { content: { "application/json": infer Body } };
}
  ? Body
  : never;
type Query<Name extends keyof operations> = operations[Name] extends { parameters: { query?: infer Given } }
  ? NonNullable<Given>
  : never;

/** Every operation of the service as a method. */
export abstract class Operations {
  /** Sends a request and returns its answer. */
  protected abstract ask<Answer>(asked: Asked, options: Options): Promise<Answer>;

${methods.join("\n")}}
`;
writeFileSync(new URL("./src/operations.ts", import.meta.url), head + operations);
