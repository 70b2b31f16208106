// SPDX-License-Identifier: BSD-3-Clause
// The newest block of profiles: a map of a grid, or a curve where it has a single row or column.
"use strict";

const Fields = (() => {
  function bounds(rows) {
    let low = Infinity, high = -Infinity;
    for (const v of rows.flat()) {
      if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
    }
    return low <= high ? [low, high] : [0, 1];
  }

  function drawMap(context, rows, [low, high], left, top, width, height) {
    const nx = rows[0].length, ny = rows.length;
    rows.forEach((row, j) => row.forEach((v, i) => {
      if (v === null) return;
      const [r, g, b] = Discs.mix(high > low ? (v - low) / (high - low) : 0.5);
      context.fillStyle = `rgb(${r},${g},${b})`;
      const x = left + width * i / nx, y = top + height * (ny - 1 - j) / ny;
      context.fillRect(x, y, width / nx + 0.5, height / ny + 0.5);
    }));
  }

  function drawCurve(context, values, [low, high], left, top, width, height) {
    const room = high > low ? high - low : 1;
    context.beginPath();
    values.forEach((v, i) => {
      if (v === null) return;
      context.lineTo(left + width * (i + 0.5) / values.length,
                     top + height * (1 - (v - low) / room));
    });
    context.stroke();
  }

  function draw(canvas, field) {
    const ratio = window.devicePixelRatio || 1, style = getComputedStyle(document.documentElement);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d"), range = bounds(field.rows);
    context.scale(ratio, ratio);
    context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
    context.fillStyle = context.strokeStyle = style.getPropertyValue("--soft");
    context.fillText(`${Curves.number(range[0])} to ${Curves.number(range[1])}`, 8, 13);
    context.textAlign = "right";
    context.fillText(`up to step ${field.step}`, width - 8, 13);
    context.lineWidth = 1.5;
    context.strokeStyle = style.getPropertyValue("--accent");
    const isMap = field.rows.length > 1 && field.rows[0].length > 1;
    (isMap ? drawMap : drawCurve)(context, isMap ? field.rows : field.rows.flat(), range, 8, 18,
                                  width - 16, height - 26);
  }

  return { draw };
})();
