// Short functions for elements of the document.

/// An element with attributes and children; attributes named on… are listeners.
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== false && value !== null) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

export const find = (id) => document.getElementById(id);

/// A picture, with a place for names of its points.
export function figure(id, caption) {
  return make("figure", { id },
    make("figcaption", {}, caption),
    make("div", { class: "canvas" },
      make("canvas", { tabindex: "0", role: "img", "aria-label": `${caption}. Arrow keys turn it, plus and minus zoom.` }),
      make("div", { class: "names", "aria-hidden": "true" })));
}

const seconds = 4;

/// A position that runs to 1 in some seconds.
export class Player {
  /// \param position from 0 to 1, where it begins
  /// \param show called with each position, and when it stops
  constructor(position, show) {
    this.position = position;
    this.show = show;
    this.isPlaying = false;
  }

  toggle() {
    this.isPlaying = !this.isPlaying;
    let [last, position] = [performance.now(), this.position()];
    if (position >= 1) position = 0;
    const tick = (now) => {
      if (this.isPlaying) position = Math.min(1, position + (now - last) / (1000 * seconds));
      last = now;
      this.isPlaying = this.isPlaying && position < 1;
      this.show(position);
      if (this.isPlaying) requestAnimationFrame(tick);
    };
    tick(last);
  }
}
