// Diagrams to read off and modes to watch. Data come as JSON in the page; nothing is fetched.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  document.documentElement.classList.add("has-script");
  const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#882255"];
  const DASHES = ["", "7 3", "2 3", "9 3 2 3"];
  const SVG = "http://www.w3.org/2000/svg";
  const SEA_LEVEL = 1.225; // kg/m³, for equivalent airspeed

  const element = (parent, tag, attributes = {}, text = "") => {
    const made = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text) made.textContent = text;
    parent.append(made);
    return made;
  };
  const digits = (value, count) => (value === null || value === undefined ? "–" : value.toFixed(count));

  // Abscissae of the V-g-f diagram.
  const abscissae = {
    tas: { name: "true airspeed V [m/s]", of: (speed) => speed },
    eas: { name: "equivalent airspeed [m/s]", of: (speed, density) => speed * Math.sqrt(density / SEA_LEVEL) },
    pressure: { name: "dynamic pressure q [Pa]", of: (speed, density) => 0.5 * density * speed * speed },
  };
  const shown = new Set(data.branches.map((branch) => branch.name));
  const look = new Map(data.branches.map((branch, i) => [branch.name,
    { colour: COLOURS[i % COLOURS.length], dash: DASHES[Math.floor(i / COLOURS.length) % DASHES.length] }]));

  // A step of 1, 2 or 5 times a power of ten that gives about so many ticks.
  const roundStep = (span, ticks) => {
    const raw = span / ticks;
    const power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10].map((m) => m * power).find((step) => step >= raw * 0.999);
  };

  class Plot {
    constructor(holder, { yName, height, lines, marks, limits }) {
      Object.assign(this, { holder, yName, height, lines, marks, limits });
      this.width = 1000;
      this.svg = element(holder, "svg", { viewBox: `0 0 ${this.width} ${height}`, role: "img", "aria-label": yName });
      this.tip = document.createElement("div");
      this.tip.className = "tip";
      holder.append(this.tip);
      this.svg.addEventListener("pointermove", (event) => this.hover(event));
      this.svg.addEventListener("pointerleave", () => this.leave());
      this.svg.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
      this.svg.addEventListener("dblclick", () => { this.view = null; this.draw(); });
      this.view = null;
    }

    draw() {
      // Letters keep their size on narrow screens: the drawing shrinks, they grow.
      const seen = this.holder.clientWidth || this.width;
      this.letters = Math.max(1, Math.min(1.8, this.width / seen));
      const { left, right, top, bottom } = { left: 84 * this.letters, right: this.width - 16, top: 12,
        bottom: this.height - 56 * this.letters };
      this.lineData = this.lines().filter((line) => shown.has(line.branch));
      const all = this.lines().flatMap((line) => line.points);
      const [x, y] = this.view || this.limits(all);
      this.range = [x, y];
      this.place = ([a, b]) => [left + ((a - x[0]) / (x[1] - x[0])) * (right - left),
        bottom - ((b - y[0]) / (y[1] - y[0])) * (bottom - top)];
      this.box = { left, right, top, bottom };
      this.svg.replaceChildren();
      const clip = element(element(this.svg, "defs"), "clipPath", { id: `clip-${this.holder.id}` });
      element(clip, "rect", { x: left, y: top, width: right - left, height: bottom - top });
      this.axis(x, y);
      const area = element(this.svg, "g", { "clip-path": `url(#clip-${this.holder.id})` });
      for (const line of this.lineData) {
        const { colour, dash } = look.get(line.branch) || { colour: "#777777", dash: "" };
        const points = line.points.map(this.place).map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" ");
        if (line.isCrosses) {
          for (const point of line.points) this.cross(area, this.place(point), colour);
        } else {
          element(area, "polyline", { points, fill: "none", stroke: colour, "stroke-width": 2, "stroke-dasharray": dash });
        }
      }
      for (const mark of this.marks().filter((m) => shown.has(m.branch))) {
        const [cx, cy] = this.place(mark.point);
        element(area, "circle", { cx, cy, r: 6, fill: "none", stroke: "#b2182b", "stroke-width": 2 });
      }
      this.ring = element(this.svg, "circle", { r: 5, fill: "none", stroke: "#222", "stroke-width": 2, visibility: "hidden" });
    }

    cross(area, [x, y], colour) {
      element(area, "path", { d: `M${x - 3} ${y - 3}l6 6m0 -6l-6 6`, stroke: colour, "stroke-width": 1, opacity: 0.7 });
    }

    axis(x, y) {
      const { left, right, top, bottom } = this.box;
      const tick = (range, count, draw) => {
        const step = roundStep(range[1] - range[0], count);
        const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
        for (let n = Math.ceil(range[0] / step - 1e-9); n * step <= range[1] + 1e-9 * step; n += 1) {
          draw(n * step, (n * step).toFixed(decimals).replace("-", "−"), n === 0);
        }
      };
      const [small, large] = [13 * this.letters, 14 * this.letters];
      const line = (x1, y1, x2, y2, isZero) => element(this.svg, "line",
        { x1, y1, x2, y2, stroke: isZero ? "#777" : "#e3e3e3", "stroke-width": isZero ? 1.5 : 1 });
      tick(x, Math.round(9 / this.letters), (value, text, isZero) => {
        const [at] = this.place([value, y[0]]);
        line(at, top, at, bottom, isZero);
        element(this.svg, "text", { x: at, y: bottom + 18 * this.letters, "text-anchor": "middle", "font-size": small }, text);
      });
      tick(y, 7, (value, text, isZero) => {
        const [, at] = this.place([x[0], value]);
        line(left, at, right, at, isZero);
        element(this.svg, "text", { x: left - 8, y: at + 4 * this.letters, "text-anchor": "end", "font-size": small }, text);
      });
      element(this.svg, "rect", { x: left, y: top, width: right - left, height: bottom - top, fill: "none", stroke: "#222" });
      element(this.svg, "text", { x: (left + right) / 2, y: bottom + 44 * this.letters, "text-anchor": "middle", "font-size": large }, this.xName());
      const [tx, ty] = [22 * this.letters, (top + bottom) / 2];
      element(this.svg, "text", { x: tx, y: ty, "text-anchor": "middle", "font-size": large, transform: `rotate(-90 ${tx} ${ty})` }, this.yName);
    }

    pixel(event) {
      const box = this.svg.getBoundingClientRect();
      return [((event.clientX - box.left) / box.width) * this.width, ((event.clientY - box.top) / box.height) * this.height];
    }

    hover(event) {
      const [px, py] = this.pixel(event);
      let best = null;
      for (const line of this.lineData) {
        line.points.forEach((point, i) => {
          const [x, y] = this.place(point);
          const distance = Math.hypot(x - px, y - py);
          if (distance < 24 && (!best || distance < best.distance)) best = { distance, x, y, text: line.text(i) };
        });
      }
      if (!best) { this.leave(); return; }
      const box = this.svg.getBoundingClientRect();
      const scale = box.width / this.width;
      this.tip.textContent = best.text;
      this.tip.style.display = "block";
      const room = this.holder.clientWidth - this.tip.offsetWidth - 8;
      this.tip.style.left = `${Math.max(0, Math.min(best.x * scale + 14, room))}px`;
      this.tip.style.top = `${best.y * scale + 14}px`;
      this.ring.setAttribute("cx", best.x);
      this.ring.setAttribute("cy", best.y);
      this.ring.setAttribute("visibility", "visible");
    }

    leave() {
      this.tip.style.display = "none";
      if (this.ring) this.ring.setAttribute("visibility", "hidden");
    }

    zoom(event) {
      if (!event.ctrlKey && !event.shiftKey) return; // the page scrolls
      event.preventDefault();
      const [px, py] = this.pixel(event);
      const { left, right, top, bottom } = this.box;
      const factor = event.deltaY > 0 ? 1.25 : 0.8;
      const parts = [(px - left) / (right - left), (bottom - py) / (bottom - top)];
      this.view = this.range.map(([low, high], i) => {
        const centre = low + parts[i] * (high - low);
        return [centre + (low - centre) * factor, centre + (high - centre) * factor];
      });
      this.draw();
    }
  }

  const words = (branch, i) => `${branch.name}${branch.method ? ` (${branch.method})` : ""}\n` +
    `V ${digits(branch.speed[i], 2)} m/s   f ${digits(branch.f[i], 3)} Hz\n` +
    `g ${digits(branch.g[i], 5)}   k ${digits(branch.k[i], 4)}\n` +
    `2σ/ω ${digits(branch.d[i], 4)}   damping ratio ${digits(branch.ratio[i], 4)}`;
  const densityOf = (branch, i) => (branch.density ? branch.density[i] : data.density);
  const extent = (values, margin) => {
    // Not Math.min(...values): arguments are limited, points of a long sweep are not.
    let [low, high] = [Infinity, -Infinity];
    for (const value of values) { low = Math.min(low, value); high = Math.max(high, value); }
    if (!(high > low)) { low -= 1; high += 1; }
    return [low - margin * (high - low), high + margin * (high - low)];
  };
  let abscissa = "tas";
  const sets = () => data.branches.map((branch) => [branch, false]).concat(data.crosses.map((branch) => [branch, true]));
  const locus = () => sets().map(([branch, isCrosses]) => ({
    branch: branch.name, isCrosses, text: (i) => words(branch, i),
    points: branch.g.map((g, i) => [g, branch.k[i]]),
  }));
  const over = (value) => () => sets().map(([branch, isCrosses]) => {
    const kept = branch.speed.map((_, i) => i).filter((i) => value(branch, i) !== null);
    return {
      branch: branch.name, isCrosses, text: (i) => words(branch, kept[i]),
      points: kept.map((i) => [abscissae[abscissa].of(branch.speed[i], densityOf(branch, i)), value(branch, i)]),
    };
  });
  const crossingAt = (c) => abscissae[abscissa].of(c.speed, c.density);
  const plots = [];
  const add = (id, options) => {
    const holder = document.getElementById(id);
    if (!holder) return;
    const plot = new Plot(holder, options);
    plot.xName = options.xName;
    plots.push(plot);
  };
  add("plot-locus", {
    yName: "reduced frequency k = ωb/U [–]", height: 620, lines: locus, xName: () => "reduced damping g = σb/U [–]",
    marks: () => data.crossings.map((c) => ({ branch: c.branch, point: [0, c.k] })),
    limits: (all) => [extent(all.map((p) => p[0]).concat([-0.01, 0.01]), 0.04), extent(all.map((p) => p[1]).concat([0, 0.05]), 0.03)],
  });
  add("plot-frequency", {
    yName: "frequency f [Hz]", height: 420, lines: over((b, i) => b.f[i]), xName: () => abscissae[abscissa].name,
    marks: () => data.crossings.map((c) => ({ branch: c.branch, point: [crossingAt(c), c.f] })),
    limits: (all) => [extent(all.map((p) => p[0]), 0), extent(all.map((p) => p[1]).concat([0]), 0.03)],
  });
  add("plot-damping", {
    yName: "structural damping 2σ/ω [–]", height: 420, lines: over((b, i) => b.d[i]), xName: () => abscissae[abscissa].name,
    marks: () => data.crossings.map((c) => ({ branch: c.branch, point: [crossingAt(c), 0] })),
    // Strongly damped roots would flatten the rest.
    limits: (all) => [extent(all.map((p) => p[0]), 0), extent(all.map((p) => Math.max(-0.6, Math.min(0.6, p[1]))).concat([-0.05, 0.05]), 0.03)],
  });
  const drawAll = () => plots.forEach((plot) => plot.draw());
  addEventListener("resize", () => { if (plots.every((plot) => plot.lineData)) drawAll(); });

  const legend = document.getElementById("legend");
  if (legend) {
    for (const branch of data.branches) {
      const { colour, dash } = look.get(branch.name);
      const label = document.createElement("label");
      const box = document.createElement("input");
      box.type = "checkbox";
      box.checked = true;
      box.addEventListener("change", () => {
        if (box.checked) shown.add(branch.name); else shown.delete(branch.name);
        drawAll();
      });
      const sample = document.createElementNS(SVG, "svg");
      element(sample, "line", { x1: 2, x2: 28, y1: 6, y2: 6, stroke: colour, "stroke-width": 2.5, "stroke-dasharray": dash });
      label.append(box, sample, ` ${branch.name}`);
      legend.append(label);
    }
    const setAll = (value) => {
      for (const box of legend.querySelectorAll("input")) if (box.checked !== value) box.click();
    };
    document.getElementById("all").addEventListener("click", () => setAll(true));
    document.getElementById("none").addEventListener("click", () => setAll(false));
    document.getElementById("abscissa").addEventListener("change", (event) => {
      abscissa = event.target.value;
      plots.forEach((plot) => { plot.view = null; });
      drawAll();
    });
    drawAll();
  }

  // The surface and what moves on it.
  const canvas = document.getElementById("viewer");
  if (!canvas || !data.surface) return;
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const quantised = (packed) => Float32Array.from(new Int16Array(bytes(packed.values).buffer), (v) => v * packed.scale);
  const points = quantised(data.surface.points);
  const corners = new Uint32Array(bytes(data.surface.triangles).buffer);
  const pressure = data.surface.pressure && quantised(data.surface.pressure);
  const count = corners.length / 3;
  const centre = [0, 1, 2].map((axis) => {
    let [low, high] = [Infinity, -Infinity];
    for (let i = axis; i < points.length; i += 3) { low = Math.min(low, points[i]); high = Math.max(high, points[i]); }
    return [(low + high) / 2, high - low];
  });
  const size = Math.hypot(...centre.map((c) => c[1]));
  const select = document.getElementById("motion");
  data.motions.forEach((motion, i) => select.append(new Option(motion.name, i)));
  if (pressure) select.append(new Option("steady pressure coefficient", "pressure"));
  const amplitude = document.getElementById("amplitude");
  const play = document.getElementById("play");
  const state = { turn: -0.7, tilt: 0.5, zoom: 1, phase: 0, isPlaying: !matchMedia("(prefers-reduced-motion: reduce)").matches };
  const moving = new Map();
  const motionOf = (index) => {
    if (!moving.has(index)) {
      const { re, im, direction } = data.motions[index];
      moving.set(index, { re: quantised(re), im: im && quantised(im), direction });
    }
    return moving.get(index);
  };
  const context = canvas.getContext("2d");
  const projected = new Float32Array(points.length);
  const coloured = new Float32Array(points.length / 3);
  const order = Array.from({ length: count }, (_, i) => i);
  const depth = new Float32Array(count);

  // White in the middle, blue below, red above: told apart by colour-blind people.
  const tint = (value, light) => {
    const v = Math.max(-1, Math.min(1, value));
    const end = v > 0 ? [178, 24, 43] : [33, 102, 172];
    const mixed = end.map((e) => (245 + (e - 245) * Math.abs(v)) * light);
    return `rgb(${mixed.map((m) => Math.round(m)).join(",")})`;
  };

  const draw = () => {
    const isPressure = select.value === "pressure";
    const motion = isPressure ? null : motionOf(Number(select.value));
    const [cosine, sine] = [Math.cos(state.phase), Math.sin(state.phase)];
    const gain = Number(amplitude.value) * size * 0.01;
    const [ct, st, cp, sp] = [Math.cos(state.turn), Math.sin(state.turn), Math.cos(state.tilt), Math.sin(state.tilt)];
    const scale = (0.95 * canvas.width * state.zoom) / size;
    for (let v = 0; v < coloured.length; v += 1) {
      const p = [0, 1, 2].map((axis) => points[3 * v + axis] - centre[axis][0]);
      if (motion) {
        let along = 0;
        for (let axis = 0; axis < 3; axis += 1) {
          const u = motion.re[3 * v + axis] * cosine - (motion.im ? motion.im[3 * v + axis] * sine : 0);
          along += u * motion.direction[axis];
          p[axis] += gain * u;
        }
        coloured[v] = along;
      }
      // Turn about z, tilt about the sideways axis; x of the screen to starboard.
      const x = p[1] * ct - p[0] * st;
      const y = p[1] * st + p[0] * ct;
      projected[3 * v] = canvas.width / 2 + scale * x;
      projected[3 * v + 1] = canvas.height / 2 - scale * (p[2] * cp - y * sp);
      projected[3 * v + 2] = y * cp + p[2] * sp;
    }
    for (let t = 0; t < count; t += 1) {
      depth[t] = projected[3 * corners[3 * t] + 2] + projected[3 * corners[3 * t + 1] + 2] + projected[3 * corners[3 * t + 2] + 2];
    }
    order.sort((a, b) => depth[a] - depth[b]);
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.lineWidth = 0.7;
    for (const t of order) {
      const [a, b, c] = [3 * corners[3 * t], 3 * corners[3 * t + 1], 3 * corners[3 * t + 2]];
      const [ux, uy] = [projected[b] - projected[a], projected[b + 1] - projected[a + 1]];
      const [wx, wy] = [projected[c] - projected[a], projected[c + 1] - projected[a + 1]];
      const facing = ux * wy - uy * wx; // screen y points down: negative faces the viewer
      if (facing > 0) continue;
      const [uz, wz] = [(projected[b + 2] - projected[a + 2]) * scale, (projected[c + 2] - projected[a + 2]) * scale];
      const normal = [uy * wz - uz * wy, uz * wx - ux * wz, facing];
      const light = 0.62 + 0.38 * Math.abs(facing) / Math.hypot(...normal);
      const value = isPressure ? -pressure[t] / data.surface.pressureLimit
        : (coloured[a / 3] + coloured[b / 3] + coloured[c / 3]) / 3;
      context.fillStyle = tint(value, light);
      context.strokeStyle = context.fillStyle;
      context.beginPath();
      context.moveTo(projected[a], projected[a + 1]);
      context.lineTo(projected[b], projected[b + 1]);
      context.lineTo(projected[c], projected[c + 1]);
      context.closePath();
      context.fill();
      context.stroke();
    }
    bar(isPressure);
  };

  const bar = (isPressure) => {
    const [left, top, width] = [20, canvas.height - 34, 220];
    for (let i = 0; i < width; i += 1) {
      context.fillStyle = tint((2 * i) / width - 1, 1);
      context.fillRect(left + i, top, 1, 12);
    }
    context.fillStyle = "#222";
    context.font = "13px sans-serif";
    context.textAlign = "left";
    const limit = data.surface.pressureLimit;
    const texts = isPressure
      ? [`c_p ${limit.toFixed(2)}`, "0", `−${limit.toFixed(2)} (suction)`]
      : ["−1", "0", "displacement over the largest"];
    context.fillText(texts[0], left, top - 6);
    context.textAlign = "center";
    context.fillText(texts[1], left + width / 2, top - 6);
    context.textAlign = "left";
    context.fillText(texts[2], left + width - 8, top - 6);
  };

  let last = 0;
  const frame = (now) => {
    if (state.isPlaying && select.value !== "pressure") {
      state.phase += ((now - last) / 1000) * Math.PI; // one cycle in two seconds
      draw();
    }
    last = now;
    requestAnimationFrame(frame);
  };
  const label = () => { play.textContent = state.isPlaying ? "pause" : "play"; };
  play.addEventListener("click", () => { state.isPlaying = !state.isPlaying; label(); });
  select.addEventListener("change", draw);
  amplitude.addEventListener("input", draw);
  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { held = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    state.turn += (event.clientX - held[0]) * 0.01;
    state.tilt = Math.max(-1.57, Math.min(1.57, state.tilt + (event.clientY - held[1]) * 0.01));
    held = [event.clientX, event.clientY];
    draw();
  });
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  canvas.addEventListener("wheel", (event) => {
    // The page scrolls, until the viewer is clicked or Ctrl is held.
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    state.zoom = Math.max(0.3, Math.min(12, state.zoom * (event.deltaY > 0 ? 0.9 : 1.1)));
    draw();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const keys = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (event.key === "+" || event.key === "-") state.zoom *= event.key === "+" ? 1.1 : 0.9;
    else if (event.key === " ") play.click();
    else if (keys[event.key]) { state.turn += keys[event.key][0]; state.tilt += keys[event.key][1]; } else return;
    event.preventDefault();
    draw();
  });
  label();
  draw();
  requestAnimationFrame((now) => { last = now; requestAnimationFrame(frame); });
})();
