"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const names = ["scene", "strategy", "filter", "depth", "format", "footprints max", "p99", "mean", "texels max",
    "PSNR dB", "SSIM", "coverage", "PC ns/px"];
  const [SCENE, STRATEGY, FILTER, DEPTH, FORMAT, FOOTPRINTS] = [0, 1, 2, 3, 4, 5];
  const PSNR = 9, COSTS = names.length;
  const element = (name, text) => Object.assign(document.createElement(name), { textContent: text ?? "" });
  const number = (n, digits) => n === null || n === undefined ? "" : n.toFixed(digits);
  const significant = n => n === 0 || n >= 100 ? n.toFixed(0)
    : n.toFixed(Math.min(6, Math.max(0, 2 - Math.floor(Math.log10(n)))));
  for (const hidden of document.querySelectorAll(".scripted")) hidden.hidden = false;

  // A setting as the tables without scripts name it.
  const setting = row => row[STRATEGY] + (row[FILTER] === "nearest" ? "" : ` ${row[FILTER]}`)
    + (row[DEPTH] === "none" ? "" : ` ${row[DEPTH]}`) + (row[FORMAT] === "rgb565:sized" ? ", sized texture" : "");

  function table(headings, rows) {
    const table = element("table");
    const head = table.createTHead().insertRow();
    for (const heading of headings) head.append(element("th", heading));
    const body = table.createTBody();
    for (const [first, ...rest] of rows) {
      const line = body.insertRow();
      line.append(element("th", first));
      for (const cell of rest) line.append(element("td", cell));
    }
    const scroll = element("div");
    scroll.className = "scroll";
    scroll.append(table);
    return scroll;
  }

  // The question form.
  const ask = document.getElementById("ask");
  function answer() {
    const chip = data.chips.find(c => c.name === ask.elements.chip.value);
    const [most, error, pixels] = ["milliseconds", "footprints", "pixels"].map(n => Number(ask.elements[n].value));
    const scenes = ask.elements.scene.value ? [ask.elements.scene.value] : data.surfaces;
    const core = data.cores.indexOf(chip.core);
    const found = new Map();
    for (const row of data.rows) {
      const cost = row[COSTS][core];
      if (!cost || !scenes.includes(row[SCENE])) continue;
      const time = cost[1] * pixels / (chip.clock * 1e3);
      const known = found.get(setting(row)) ?? { count: 0, time: 0, error: -1, how: "", worst: "" };
      known.count += 1;
      if (time > known.time) [known.time, known.how] = [time, cost[2].replace("-", " ")];
      if (row[FOOTPRINTS] > known.error) [known.error, known.worst] = [row[FOOTPRINTS], row[SCENE]];
      found.set(setting(row), known);
    }
    const all = [...found].filter(([, known]) => known.count === scenes.length);
    const excess = known => Math.max(known.time > most ? known.time / most : 0,
      known.error > error ? known.error / error : 0);
    const fits = all.filter(([, known]) => excess(known) <= 1).sort((a, b) => a[1].time - b[1].time);
    const nearest = all.filter(([, known]) => excess(known) > 1).sort((a, b) => excess(a[1]) - excess(b[1]));
    const line = ([name, k]) => [name, number(k.time, 1), k.how, significant(k.error), k.worst];
    const say = fits.length ? `${fits.length} settings stay within both limits in ${scenes.join(", ")}; the fastest first.`
      : `Nothing stays within both limits in ${scenes.join(", ")}; the nearest first.`;
    document.getElementById("found").replaceChildren(element("p", say),
      table(["setting", "ms", "cycles are", "footprints, at most", "in"], (fits.length ? fits : nearest).slice(0, 12).map(line)));
  }
  ask.addEventListener("input", answer);
  ask.addEventListener("submit", event => event.preventDefault());
  answer();

  // One plot at a time.
  const choose = document.getElementById("choose");
  function plot() {
    const { core, scene, unit } = choose.elements;
    for (const details of document.querySelectorAll("#plots > details")) {
      const of = details.querySelector(".plot").dataset;
      details.open = of.core === core.value && of.scene === scene.value && of.unit === unit.value;
      details.hidden = !details.open;
    }
  }
  choose.addEventListener("input", plot);
  plot();

  // The table of everything.
  const MOST = 300;
  const columns = [...names, ...data.cores.map(core => `${core} instr/px`)];
  const cell = (row, column) => column < COSTS ? row[column] : row[COSTS][column - COSTS]?.[0] ?? null;
  // Equal pictures have no noise: more than any number.
  const value = (row, column) => column === PSNR && row[PSNR] === null && row[PSNR + 1] !== null
    ? Infinity : cell(row, column);
  const shownAs = (row, column) => {
    const n = value(row, column);
    if (n === null || typeof n === "string") return n ?? "";
    if (n === Infinity) return "equal";
    return column === 11 ? String(n) : column === 10 ? n.toFixed(4) : column >= PSNR ? n.toFixed(column >= COSTS ? 1 : 2) : significant(n);
  };
  const filter = document.getElementById("filter");
  const starts = { scene: "oblique", filter: "nearest", depth: "none" };
  for (const [column, name] of ["scene", "strategy", "filter", "depth"].entries()) {
    const select = filter.elements[name];
    select.append(Object.assign(element("option", "all"), { value: "" }));
    for (const option of new Set(data.rows.map(row => row[column]))) select.append(element("option", option));
    select.value = starts[name] ?? "";
  }
  const explorer = document.getElementById("explorer");
  let [by, up] = [FOOTPRINTS, true];
  const head = explorer.tHead.insertRow();
  for (const [column, name] of columns.entries()) {
    const th = element("th"), button = element("button", name);
    button.type = "button";
    button.addEventListener("click", () => {
      [by, up] = [column, by === column ? !up : true];
      list();
    });
    th.append(button);
    head.append(th);
  }
  function list() {
    const wanted = ["scene", "strategy", "filter", "depth"].map(name => filter.elements[name].value);
    const rows = data.rows.filter(row => wanted.every((want, column) => !want || row[column] === want));
    // What is unknown comes last, whichever way.
    const order = (a, b) => {
      const [x, y] = [value(a, by), value(b, by)];
      if (x === null || y === null) return (x === null) - (y === null);
      return (x < y ? -1 : x > y ? 1 : 0) * (up ? 1 : -1);
    };
    rows.sort(order);
    explorer.tBodies[0].replaceChildren(...rows.slice(0, MOST).map(row => {
      const line = element("tr");
      for (const column of columns.keys()) line.append(element(column < FOOTPRINTS ? "th" : "td", shownAs(row, column)));
      return line;
    }));
    for (const [column, th] of [...head.cells].entries()) {
      th.ariaSort = column === by ? (up ? "ascending" : "descending") : "none";
      th.firstChild.textContent = columns[column] + (column === by ? (up ? " ▲" : " ▼") : "");
    }
    document.getElementById("shown").textContent = rows.length > MOST
      ? `The first ${MOST} of ${rows.length} rows; report.csv has all.` : `${rows.length} rows.`;
  }
  filter.addEventListener("input", list);
  list();

  // Two pictures and a border between them.
  const slider = document.getElementById("slider");
  const form = slider.querySelector("form"), compare = slider.querySelector(".compare");
  const gallery = () => document.querySelector(`.gallery[data-scene="${form.elements.scene.value}"]`);
  const figures = () => [...gallery().querySelectorAll("figure[data-names]")];
  function techniques() {
    const { technique } = form.elements;
    const before = technique.value || "every:16";
    const known = figures().flatMap(figure => figure.dataset.names.split("|"));
    technique.replaceChildren(...known.map(name => element("option", name)));
    technique.value = known.includes(before) ? before : known[0];
  }
  function show() {
    const name = form.elements.technique.value;
    const figure = figures().find(f => f.dataset.names.split("|").includes(name));
    const source = kind => (kind === "reference" ? gallery() : figure).querySelector(`img[data-kind="${kind}"]`);
    const missing = [];
    for (const side of ["left", "right"]) {
      const kind = form.elements[side].value, from = source(kind), image = compare.querySelector(`img.${side}`);
      image.src = from ? from.src : "data:,";
      image.alt = from ? from.alt : "";
      if (!from) missing.push(kind === "map" ? "error" : kind);
    }
    const row = data.rows.find(r => r[SCENE] === form.elements.scene.value && r[STRATEGY] === name
      && r[FILTER] === "nearest");
    const error = row ? `: ${significant(row[FOOTPRINTS])} footprints at most, ${shownAs(row, PSNR)}${shownAs(row, PSNR) === "equal" ? " to the reference" : " dB"}` : "";
    document.getElementById("caption").textContent =
      `${form.elements.scene.value}, ${name}${error}${missing.length ? `; no picture of its ${missing.join(", ")}` : ""}`;
  }
  form.elements.scene.addEventListener("input", techniques);
  form.addEventListener("input", show);
  compare.querySelector("input").addEventListener("input", event => compare.style.setProperty("--at", `${event.target.value}%`));
  techniques();
  show();
})();
