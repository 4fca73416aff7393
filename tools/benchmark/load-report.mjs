// node load-report.mjs bridge|cloud DIR: the tables of tools/bench out of what gvom-summary and the readers said.
import { readFileSync } from "node:fs";

const [kind, folder] = process.argv.slice(2);

const summary = (name) => JSON.parse(readFileSync(`${folder}/${name}.json`, "utf8"));

// Lines "READER TOPIC received N missing N bytes N" or "... sent N ...".
const counts = (name) =>
  readFileSync(`${folder}/${name}.txt`, "utf8").trim().split("\n").map((line) => {
    const words = line.split(" ");
    const count = { reader: words[0], topic: words[1] };
    for (let i = 2; i + 1 < words.length; i += 2) count[words[i]] = Number(words[i + 1]);
    return count;
  });

const median = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = Math.floor(sorted.length / 2);
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
};

const table = (rows) => rows.forEach((row) => console.log(`| ${row.join(" | ")} |`));
const ms = (value) => value.toFixed(1);
const percent = (value) => `${(100 * value).toFixed(1)} %`;

// Added over the phases.
const sum = (lists) => {
  const sums = new Map();
  for (const count of lists.flat()) {
    const key = `${count.reader} ${count.topic}`;
    const known = sums.get(key);
    if (!known) sums.set(key, { ...count });
    else for (const [name, value] of Object.entries(count)) if (typeof value === "number") known[name] += value;
  }
  return [...sums.values()];
};

const printTopics = (lists) => {
  table([["reader", "topic", "received", "missing", "MB"], ["---", "---", "---", "---", "---"]]);
  table(sum(lists).filter((count) => "received" in count)
    .map((c) => [c.reader, c.topic, c.received, c.missing ?? "", (c.bytes / 1e6).toFixed(1)]));
};

const sinks = (summaries) => {
  const names = ["foxglove_sent", "foxglove_replaced", "mcap_sent", "mcap_dropped", "ros2_sent", "ros2_replaced", "ros2_dropped",
    "layers_in", "layers_skipped", "layers_lost"];
  const bridges = summaries.map((one) => one.processes.find((process) => process.name === "gvom-bridge").counters);
  return names.map((name) => `${name} ${bridges.reduce((all, counters) => all + (counters[name] ?? 0), 0)}`).join(", ");
};

const printProcessors = (without, alongside) => {
  const names = [...new Set(alongside.flatMap((one) => one.processes.map((process) => process.name)))].sort();
  const share = (summaries, name) => {
    const found = summaries.map((one) => one.processes.find((process) => process.name === name)).filter(Boolean);
    return found.length === 0 ? "" : percent(median(found.map((process) => process.share_of_a_core)));
  };
  table([["process", ...(without.length > 0 ? ["without"] : []), "of a core"], ["---", ...(without.length > 0 ? ["---"] : []), "---"]]);
  table(names.map((name) => [name, ...(without.length > 0 ? [share(without, name)] : []), share(alongside, name)]));
};

const printComplaints = (summaries) => {
  for (const one of summaries)
    for (const process of one.processes)
      for (const complaint of process.not_ok ?? [])
        if (complaint.state !== "starting") console.log(`${process.name} was ${complaint.state}: ${complaint.reason}`);
};

const reportBridge = () => {
  const names = [];
  for (let phase = 1; ; ++phase) {
    try { summary(`with-${phase}`); } catch { break; }
    names.push(phase);
  }
  const without = names.map((phase) => summary(`without-${phase}`));
  const alongside = names.map((phase) => summary(`with-${phase}`));
  table([["phase", "without: p50, p99, max (ms)", "with", "layers"], ["---", "---", "---", "---"]]);
  const words = (one) => `${ms(one.latency_ms.p50)}, ${ms(one.latency_ms.p99)}, ${ms(one.latency_ms.max)}`;
  table(names.map((phase, i) => [phase, words(without[i]), words(alongside[i]), `${without[i].layers_read}, ${alongside[i].layers_read}`]));
  const of = (list, key) => median(list.map((one) => one.latency_ms[key]));
  for (const key of ["p50", "p99"])
    console.log(`${key}, median of the phases: ${ms(of(without, key))} ms without, ${ms(of(alongside, key))} ms with: ` +
      `${(of(alongside, key) / of(without, key)).toFixed(3)} times`);
  printTopics(names.map((phase) => counts(`with-${phase}`)));
  console.log(`the bridge: ${sinks(alongside)}`);
  printProcessors(without, alongside);
  printComplaints([...without, ...alongside]);
};

const reportCloud = () => {
  const run = summary("cloud");
  const came = counts("cloud");
  const sent = (topic) => came.find((count) => count.reader === "robot" && count.topic === topic).sent;
  const counters = run.processes.find((process) => process.name === "gvom-ingest-top").counters;
  const odometry = run.processes.find((process) => process.name === "gvom-odometry").counters;
  console.log(`clouds: ${sent("/points")} sent, ${counters.packets} came, ${counters.sweeps_mapped} mapped; poses: ${sent("/odom")} sent, ` +
    `${odometry.published} came`);
  for (const [name, value] of Object.entries(counters)) if (name.startsWith("drop_") && value > 0) console.log(`  ${name} ${value}`);
  for (const name of ["lost_messages", "refused_messages", "other_publisher"])
    if (odometry[name] > 0) console.log(`  odometry: ${name} ${odometry[name]}`);
  console.log(`layers: ${run.layers_read}, p50 ${ms(run.latency_ms.p50)}, p99 ${ms(run.latency_ms.p99)}, max ${ms(run.latency_ms.max)} ms`);
  printTopics([came]);
  console.log(`the bridge: ${sinks([run])}`);
  printProcessors([], [run]);
  printComplaints([run]);
};

if (kind === "bridge") reportBridge();
else reportCloud();
