// The curve of the energy: a line stands at the time that is shown, and a finger on the curve goes to another time.
class EnergyCurve {
  constructor(playback) {
    this.playback = playback;
    this.plots = [...document.querySelectorAll("figure.energy svg.plot")].map((svg) => {
      const [left, top, wide, high, least, most] = svg.dataset.area.split(" ").map(Number);
      const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
      line.setAttribute("class", "now");
      svg.append(line);
      const plot = { svg, line, left, top, wide, high, least, most };
      const go = (event) => {
        const frame = svg.getBoundingClientRect(), [, , width] = svg.getAttribute("viewBox").split(" ").map(Number);
        const across = ((event.clientX - frame.left) / frame.width * width - left) / wide;
        playback.run(false);
        playback.seek((least + across * (most - least)) / (picture.time_step * picture.every));
      };
      svg.addEventListener("pointerdown", (event) => { svg.setPointerCapture(event.pointerId); go(event); });
      svg.addEventListener("pointermove", (event) => { if (event.buttons & 1) go(event); });
      return plot;
    });
  }

  show() {
    const time = this.playback.shown * picture.every * picture.time_step;
    for (const { line, left, top, wide, high, least, most } of this.plots) {
      const x = (left + (time - least) / (most - least) * wide).toFixed(1);
      line.setAttribute("d", `M${x} ${top}v${high}m-5 ${-high}h10l-5 7z`);
    }
  }
}
