// A Jupyter notebook that asks the service for a scene, draws its motion and prints its equations.

const PLOT = `import matplotlib.pyplot as plt

trajectory = answer.get("trajectory") or {}
columns = trajectory.get("columns", {})
units = list(dict.fromkeys(column["unit"] for column in columns.values()))
if units:
    figure, axes = plt.subplots(len(units), sharex=True, squeeze=False, figsize=(8, 2.5 * len(units)))
    for unit, axis in zip(units, axes[:, 0]):
        for name, column in columns.items():
            if column["unit"] == unit:
                axis.plot(trajectory["time"], column["values"], label=name)
        axis.set_ylabel(unit)
        axis.legend(fontsize="small")
    axes[-1, 0].set_xlabel("time (s)")`;

const askFrom = (origin, path) => `def ask(question):
    body = json.dumps(question).encode()
    request = urllib.request.Request("${origin}${path}", body, {"Content-Type": "application/json"})
    return json.load(urllib.request.urlopen(request))

answer = ask(scene)
answer.get("model")`;

const EQUATIONS = `for equation in ask({**scene, "times": [0], "outputs": ["equations"]})["equations"]["equations"]:
    print(equation["plain"])`;

/** The notebook as an object; `path` is that of the question, `scene` the question itself. */
export function notebookOf(title, origin, path, scene) {
  const text = JSON.stringify(scene, null, 1);
  const code = [`import json\nimport urllib.request\n\nscene = json.loads(r'''${text}''')`, askFrom(origin, path), PLOT, ...(path === "/v1/scenes" ? [EQUATIONS] : [])];
  const lines = (source) => source.split(/(?<=\n)/);
  const cells = code.map((source, k) => ({ cell_type: "code", id: `code-${k}`, metadata: {}, execution_count: null, outputs: [], source: lines(source) }));
  const head = { cell_type: "markdown", id: "title", metadata: {}, source: [`# ${title}`] };
  return { nbformat: 4, nbformat_minor: 5, metadata: { kernelspec: { name: "python3", display_name: "Python 3", language: "python" } }, cells: [head, ...cells] };
}
