// SPDX-License-Identifier: BSD-3-Clause
// Search in pages that are opened as files. The theme searches in a worker, but browsers start no
// worker for files. Here its script runs in a hidden frame instead, with the same two messages.
"use strict";

if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(address) {
      super();
      this.waiting = [];
      const frame = document.createElement("iframe");
      frame.hidden = true;
      frame.srcdoc = "<!doctype html>";
      frame.onload = () => this.start(frame.contentWindow, new URL(address, location.href));
      document.body.append(frame);
    }

    start(inside, address) {
      inside.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", { data }));
      const script = inside.document.createElement("script");
      script.src = address;
      script.onload = () => {
        this.inside = inside;
        this.waiting.forEach((data) => this.postMessage(data));
      };
      inside.document.head.append(script);
    }

    // Sent later than the call, as a worker's messages are.
    postMessage(data) {
      if (!this.inside) return void this.waiting.push(data);
      const message = new this.inside.MessageEvent("message", { data });
      setTimeout(() => this.inside.dispatchEvent(message));
    }
  };
}
