// SPDX-License-Identifier: BSD-3-Clause
// A curve along the run's steps, with the step that is shown.
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

  function draw(canvas, curve, lastStep, shownStep) {
    const ratio = window.devicePixelRatio || 1, style = getComputedStyle(document.documentElement);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
    context.fillStyle = style.getPropertyValue("--soft");
    if (!curve || curve.steps.length === 0) {
      words(context, curve ? curve.source : "", width - 16, 8, 18, 15);
      return;
    }
    const [low, high] = range(curve.values);
    const left = 8, right = width - 8, top = 18, bottom = height - 20;
    const end = Math.max(lastStep, curve.steps[curve.steps.length - 1], 1);
    const x = (s) => left + (s / end) * (right - left);
    const y = (v) => bottom - ((v - low) / (high - low)) * (bottom - top);
    context.fillText(number(high), left, 13);
    context.textAlign = "right";
    context.fillText(curve.source, right, 13);
    context.fillText("step " + end, right, height - 6);
    context.textAlign = "left";
    context.fillText(number(low), left, height - 6);
    context.strokeStyle = style.getPropertyValue("--line");
    context.beginPath();
    context.moveTo(left, bottom);
    context.lineTo(right, bottom);
    context.stroke();
    context.strokeStyle = style.getPropertyValue("--soft");
    context.setLineDash([3, 3]);
    context.beginPath();
    context.moveTo(x(shownStep), top);
    context.lineTo(x(shownStep), bottom);
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

  return { draw, number };
})();
