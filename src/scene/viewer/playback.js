// The time that is shown, in frames: it runs, it is dragged, it is stepped.
class Playback {
  constructor(changed) {
    this.changed = changed;
    this.time = 0;
    this.play = document.getElementById("play");
    this.at = document.getElementById("at");
    this.step = document.getElementById("step");
    this.running = false;
    /** A run takes 6 to 16 seconds, however many frames it has. */
    this.framesPerSecond = lastFrame / Math.min(16, Math.max(6, lastFrame / 40));
    if (!this.play) return;
    this.play.addEventListener("click", () => this.run(!this.running));
    this.at.addEventListener("input", () => { this.run(false); this.seek(Number(this.at.value)); });
    window.addEventListener("keydown", (event) => this.key(event));
    // A user who prefers reduced motion starts it by hand.
    this.run(!still);
  }

  run(running) {
    if (!this.play) return;
    if (running && this.time >= lastFrame) this.time = 0;
    this.running = running;
    this.last = null;
    this.play.textContent = running ? "Pause" : "Play";
    this.changed();
  }

  seek(time) {
    this.time = Math.min(lastFrame, Math.max(0, time));
    this.show();
    this.changed();
  }

  /** Goes on by the time since the last call, and begins again a second after the end. */
  tick(now) {
    if (!this.running) return;
    const passed = this.last === null ? 0 : Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    this.time += passed * this.framesPerSecond;
    if (this.time > lastFrame + this.framesPerSecond) this.time = 0;
    this.show();
  }

  get shown() {
    return Math.min(this.time, lastFrame);
  }

  show() {
    if (!this.step) return;
    const step = Math.round(this.shown * picture.every);
    this.step.value = `step ${step}`;
    this.step.title = `time ${Number((step * picture.time_step).toPrecision(6))}`;
    this.at.value = String(this.shown);
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const { tagName } = event.target;
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === " " && tagName !== "BUTTON" && tagName !== "SUMMARY") {
      this.run(!this.running);
    } else if (by) {
      this.run(false);
      this.seek(Math.round(this.shown) + by);
    } else {
      return;
    }
    event.preventDefault();
  }
}
