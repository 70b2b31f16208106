// SPDX-License-Identifier: BSD-3-Clause
// Draws a frame: discs at their true radius, or a density where there are too many.
//
// Few discs are drawn as smooth circles. Many are written into the picture row by row: 100,000
// discs take some 10 ms, and a path for each would take half a second.
"use strict";

const Discs = (() => {
  const SMOOTH = 4000;
  const ANCHORS = [[66, 92, 188], [36, 138, 186], [58, 172, 140], [168, 196, 72], [240, 180, 50],
                   [226, 88, 42], [170, 24, 48]];
  const SPECIES = [[44, 116, 188], [222, 110, 36], [58, 150, 80], [176, 60, 140], [150, 118, 20],
                   [90, 90, 200], [20, 150, 160], [190, 60, 60]];

  function mix(share) {
    const place = Math.min(Math.max(share, 0), 1) * (ANCHORS.length - 1);
    const low = Math.min(Math.floor(place), ANCHORS.length - 2), part = place - low;
    return ANCHORS[low].map((c, i) => Math.round(c + (ANCHORS[low + 1][i] - c) * part));
  }
  const table = Array.from({ length: 256 }, (_, i) => mix(i / 255));
  const packed = ([r, g, b]) => (255 << 24 | b << 16 | g << 8 | r) >>> 0;
  const packedTable = Uint32Array.from(table, packed);

  // What a value is drawn in: an index into the palette.
  function palette(frame, top) {
    if (frame.about.colour === "species") {
      return { colours: SPECIES, packed: Uint32Array.from(SPECIES, packed),
               of: (v) => v % SPECIES.length };
    }
    const scale = top > 0 ? 255.99 / top : 0;
    return { colours: table, packed: packedTable,
             of: (v) => Math.min(255, Math.max(0, v * scale)) | 0 };
  }

  // Pixels from lengths: x and y of the page's picture for a place in the box.
  function mapping(canvas, view) {
    const [x0, y0, x1, y1] = view;
    const scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0));
    const left = (canvas.width - scale * (x1 - x0)) / 2;
    const top = (canvas.height - scale * (y1 - y0)) / 2;
    return { scale, x: (x) => left + (x - x0) * scale, y: (y) => top + (y1 - y) * scale,
             toX: (px) => x0 + (px - left) / scale, toY: (py) => y1 - (py - top) / scale };
  }

  // The walls where they are at the frame's step.
  function drawWalls(context, map, [x0, y0, x1, y1]) {
    const style = getComputedStyle(document.documentElement);
    context.strokeStyle = style.getPropertyValue("--soft");
    context.lineWidth = Math.max(1, devicePixelRatio);
    context.strokeRect(map.x(x0), map.y(y1), (x1 - x0) * map.scale, (y1 - y0) * map.scale);
  }

  function drawSmooth(context, frame, map, colours) {
    const { x, y, value, about } = frame, [vx, vy] = about.view;
    const { width, height } = context.canvas;
    let drawn = 0;
    for (let i = 0; i < x.length; i++) {
      const r = Math.max(0.5, (frame.radii ? frame.radii[i] : about.radius) * map.scale);
      const px = map.x(x[i] + vx), py = map.y(y[i] + vy);
      if (px + r < 0 || py + r < 0 || px - r > width || py - r > height) continue;
      const [red, green, blue] = colours.colours[colours.of(value[i])];
      context.fillStyle = `rgb(${red},${green},${blue})`;
      context.beginPath();
      context.arc(px, py, r, 0, 2 * Math.PI);
      context.fill();
      drawn++;
    }
    return drawn;
  }

  function drawRows(context, frame, map, colours) {
    const { width, height } = context.canvas;
    const image = context.createImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const { x, y, value, about } = frame, [vx, vy] = about.view;
    const x0 = map.x(vx), y0 = map.y(vy), scale = map.scale;
    let drawn = 0;
    for (let i = 0; i < x.length; i++) {
      const r = (frame.radii ? frame.radii[i] : about.radius) * scale;
      const px = x0 + x[i] * scale, py = y0 - y[i] * scale;
      if (px + r < 0 || py + r < 0 || px - r >= width || py - r >= height) continue;
      drawn++;
      const colour = colours.packed[colours.of(value[i])];
      if (r < 0.75) {
        const a = px | 0, b = py | 0;
        if (a >= 0 && a < width && b >= 0 && b < height) pixels[b * width + a] = colour;
        continue;
      }
      const last = Math.min(height - 1, Math.floor(py + r - 0.5));
      for (let row = Math.max(0, Math.ceil(py - r - 0.5)); row <= last; row++) {
        const dy = row + 0.5 - py, half = Math.sqrt(Math.max(0, r * r - dy * dy));
        const begin = Math.max(0, Math.ceil(px - half - 0.5));
        const end = Math.min(width, Math.floor(px + half + 0.5));
        if (end > begin) pixels.fill(colour, row * width + begin, row * width + end);
      }
    }
    context.putImageData(image, 0, 0);
    return drawn;
  }

  // Colour by the mean value, stronger where discs cover more of a cell.
  function drawDensity(context, frame, map, colours) {
    const [columns, rows] = frame.about.grid, picture = document.createElement("canvas");
    picture.width = columns;
    picture.height = rows;
    const inner = picture.getContext("2d"), image = inner.createImageData(columns, rows);
    for (let i = 0; i < columns * rows; i++) {
      const row = rows - 1 - Math.floor(i / columns), at = 4 * (row * columns + i % columns);
      const colour = colours.colours[colours.of(frame.value[i])];
      for (let k = 0; k < 3; k++) image.data[at + k] = colour[k];
      image.data[at + 3] = 255 * Math.min(1, Math.sqrt(frame.fraction[i] / 0.9));
    }
    inner.putImageData(image, 0, 0);
    const [x0, y0, x1, y1] = frame.about.view;
    context.imageSmoothingEnabled = false;
    context.drawImage(picture, map.x(x0), map.y(y1), (x1 - x0) * map.scale, (y1 - y0) * map.scale);
    return frame.about.shown;
  }

  // Draws a frame in the view and returns how many discs are in the picture.
  function draw(canvas, frame, view, top) {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d"), map = mapping(canvas, view);
    context.clearRect(0, 0, width, height);
    const colours = palette(frame, top);
    let drawn;
    if (frame.about.kind === "density") drawn = drawDensity(context, frame, map, colours);
    else if (frame.x.length <= SMOOTH) drawn = drawSmooth(context, frame, map, colours);
    else drawn = drawRows(context, frame, map, colours);
    drawWalls(context, map, frame.about.walls);
    return drawn;
  }

  // The scale of values, or the colours of the first species.
  function drawGradient(canvas, nSpecies) {
    const context = canvas.getContext("2d"), list = nSpecies ? SPECIES.slice(0, nSpecies) : table;
    const width = nSpecies ? 14 : canvas.width / list.length;
    context.clearRect(0, 0, canvas.width, canvas.height);
    list.forEach(([r, g, b], i) => {
      context.fillStyle = `rgb(${r},${g},${b})`;
      context.fillRect(i * width, 0, width + 1, canvas.height);
    });
  }

  // How strong a colour is in a density, from no disc to the densest packing.
  function drawShades(canvas) {
    const context = canvas.getContext("2d"), [r, g, b] = table[128], { width, height } = canvas;
    context.clearRect(0, 0, width, height);
    for (let x = 0; x < width; x++) {
      context.fillStyle = `rgba(${r},${g},${b},${Math.sqrt((x + 0.5) / width)})`;
      context.fillRect(x, 0, 1, height);
    }
  }

  // A frame from the server's answer.
  function parse(about, numbers) {
    const frame = { about, bytes: numbers.byteLength };
    if (about.kind === "density") {
      const n = about.grid[0] * about.grid[1];
      frame.fraction = numbers.subarray(0, n);
      frame.value = numbers.subarray(n, 2 * n);
      return frame;
    }
    const n = about.shown;
    ["x", "y", "value"].forEach((name, i) => {
      frame[name] = numbers.subarray(i * n, (i + 1) * n);
    });
    if (about.has_radii) frame.radii = numbers.subarray(3 * n, 4 * n);
    return frame;
  }

  return { draw, drawGradient, drawShades, mapping, mix, parse };
})();
