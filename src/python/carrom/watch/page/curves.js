// SPDX-License-Identifier: BSD-3-Clause
// A curve along the run's steps, with the step that is shown, or along the box.
"use strict";

const Curves = (() => {
  const number = (v) => {
    if (v === 0) return "0";
    const size = Math.abs(v);
    return size >= 1e5 || size < 1e-3 ? v.toExponential(2) : String(+v.toPrecision(4));
  };

  function range(values) {
    let low = Infinity, high = -Infinity;
    for (const v of values) { low = Math.min(low, v); high = Math.max(high, v); }
    if (low === 0 && high === 0) return [0, 1];
    const room = Math.max((high - low) * 0.08, Math.abs(high) * 1e-3, 1e-300);
    return [low >= 0 && low - room < 0 ? 0 : low - room, high + room];
  }

  // Some `most` round numbers from low to high, two at least: 1, 2 or 5 times a power of ten apart.
  function ticks(low, high, most) {
    const least = (high - low) / most, power = 10 ** Math.floor(Math.log10(least));
    const apart = power * [1, 2, 5, 10].find((factor) => factor * power >= least * (1 - 1e-9));
    const found = [];
    if (!(apart > 0)) return [low];
    for (let k = Math.ceil(low / apart - 1e-9); k * apart <= high + 1e-9 * apart; k++)
      found.push(k * apart);
    return found.length > 1 || most > 8 ? found : ticks(low, high, 2 * most);
  }

  // With the digits in which neighbours differ.
  function tickNames(values) {
    const apart = values.length > 1 ? values[1] - values[0] : Math.abs(values[0]) || 1;
    const largest = Math.max(...values.map(Math.abs));
    if (largest >= 1e7 || largest < 1e-4 && largest > 0)
      return values.map((v) => v.toExponential(2));
    const digits = Math.min(12, Math.max(0, -Math.floor(Math.log10(apart) + 1e-9)));
    return values.map((v) => (v === 0 ? 0 : v).toFixed(digits));
  }

  function words(context, text, width, x, y, lineHeight) {
    let line = "";
    for (const word of text.split(" ")) {
      if (line && context.measureText(line + " " + word).width > width) {
        context.fillText(line, x, y);
        line = word;
        y += lineHeight;
      } else line = line ? line + " " + word : word;
    }
    context.fillText(line, x, y);
  }

  // The canvas without its old picture, in the pixels of the page.
  function cleared(canvas) {
    const ratio = window.devicePixelRatio || 1, style = getComputedStyle(document.documentElement);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
    return { context, width, height, style };
  }

  // `shownStep` is null where no step is marked. `axis` is the name of what `curve.steps` has, and
  // `begin` where it begins.
  function draw(canvas, curve, lastStep, shownStep, axis = "step", begin = 0) {
    const { context, width, height, style } = cleared(canvas);
    context.fillStyle = style.getPropertyValue("--soft");
    if (!curve || curve.steps.length === 0) {
      words(context, curve ? curve.source : "", width - 16, 8, 18, 15);
      return;
    }
    const [low, high] = range(curve.values);
    const last = Math.max(lastStep, curve.steps[curve.steps.length - 1]);
    const end = last > begin ? last : begin + 1;
    const heights = ticks(low, high, height > 110 ? 4 : 2);
    const names = tickNames(heights);
    const left = 14 + Math.max(...names.map((name) => context.measureText(name).width));
    const right = width - 8, top = 18, bottom = height - 20;
    const x = (s) => left + ((s - begin) / (end - begin)) * (right - left);
    const y = (v) => bottom - ((v - low) / (high - low)) * (bottom - top);
    context.textAlign = "right";
    context.fillText(curve.source, right, 13);
    context.strokeStyle = style.getPropertyValue("--line");
    context.beginPath();
    heights.forEach((v, i) => {
      context.fillText(names[i], left - 5, y(v) + 4);
      context.moveTo(left, y(v));
      context.lineTo(right, y(v));
    });
    context.textAlign = "center";
    const steps = ticks(begin, end, Math.max(2, Math.floor((right - left) / 75)));
    const stepNames = tickNames(steps);
    steps.forEach((s, i) => {
      const name = i === 0 ? `${axis} ${stepNames[i]}` : stepNames[i];
      const half = context.measureText(name).width / 2;
      context.fillText(name, Math.min(Math.max(x(s), half + 2), width - half - 2), height - 6);
      context.moveTo(x(s), bottom);
      context.lineTo(x(s), bottom + 4);
    });
    context.moveTo(left, top);
    context.lineTo(left, bottom);
    context.lineTo(right, bottom);
    context.stroke();
    context.textAlign = "left";
    context.strokeStyle = style.getPropertyValue("--soft");
    context.setLineDash([3, 3]);
    context.beginPath();
    if (shownStep !== null) {
      context.moveTo(x(shownStep), top);
      context.lineTo(x(shownStep), bottom);
    }
    context.stroke();
    context.setLineDash([]);
    context.strokeStyle = context.fillStyle = style.getPropertyValue("--accent");
    context.lineWidth = 1.5;
    context.beginPath();
    curve.steps.forEach((s, i) => context.lineTo(x(s), y(curve.values[i])));
    context.stroke();
    if (curve.steps.length < 40) {
      curve.steps.forEach((s, i) => {
        context.fillRect(x(s) - 1.5, y(curve.values[i]) - 1.5, 3, 3);
      });
    }
  }

  return { cleared, draw, number };
})();
