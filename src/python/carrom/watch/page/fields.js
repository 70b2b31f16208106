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

  // The side of the box along which the centres of cells lie; a single cell has its centre alone.
  function sideOf(places) {
    const n = places.length, first = places[0], last = places[n - 1];
    return n > 1 ? (last - first) * n / (n - 1) : 2 * first;
  }

  // As long and high as the box, so that a round spot in it is round here.
  function drawMap(canvas, field) {
    const { context, width, height, style } = Curves.cleared(canvas);
    const { rows, x, y } = field, nx = x.length, ny = y.length, [low, high] = bounds(rows);
    context.fillStyle = style.getPropertyValue("--soft");
    context.fillText(`${Curves.number(low)} to ${Curves.number(high)}`, 8, 13);
    context.textAlign = "right";
    context.fillText(`up to step ${field.step}`, width - 8, 13);
    const scale = Math.min((width - 16) / sideOf(x), (height - 26) / sideOf(y));
    const across = scale * sideOf(x) / nx, up = scale * sideOf(y) / ny;
    const left = (width - across * nx) / 2, top = 18 + (height - 26 - up * ny) / 2;
    rows.forEach((row, j) => row.forEach((v, i) => {
      if (v === null) return;
      const [r, g, b] = Discs.mix(high > low ? (v - low) / (high - low) : 0.5);
      context.fillStyle = `rgb(${r},${g},${b})`;
      context.fillRect(left + across * i, top + up * (ny - 1 - j), across + 0.5, up + 0.5);
    }));
  }

  // Along x or y. Cells without discs have no value, so the curve leaves them out.
  function drawCurve(canvas, field, axis) {
    const all = field.rows.flat(), places = field[axis], n = places.length;
    const known = all.map((v, i) => i).filter((i) => all[i] !== null);
    const curve = { steps: known.map((i) => places[i]), values: known.map((i) => all[i]),
                    source: `up to step ${field.step}` };
    const side = sideOf(places), half = side / (2 * n), low = places[0] - half;
    const begin = Math.abs(low) < 1e-9 * side ? 0 : low; // with box.origin not 0
    Curves.draw(canvas, curve, places[n - 1] + half, null, axis, begin);
  }

  function draw(canvas, field) {
    document.body.dataset.field = `${field.x.length} by ${field.y.length}`;
    if (field.x.length > 1 && field.y.length > 1) drawMap(canvas, field);
    else drawCurve(canvas, field, field.x.length > 1 ? "x" : "y");
  }

  return { draw };
})();
