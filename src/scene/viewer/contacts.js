// The list of contacts: one is chosen at a time, the camera goes there, and its point and normal are drawn.
class Contacts {
  constructor(playback, camera, changed) {
    Object.assign(this, { playback, camera, changed });
    this.chosen = -1;
    this.table = document.getElementById("contacts");
    if (!this.table) return;
    this.rows = [...this.table.tBodies[0].rows];
    this.rows.forEach((row, number) => row.addEventListener("click", () => this.choose(number)));
    document.getElementById("previous").addEventListener("click", () => this.by(-1));
    document.getElementById("next").addEventListener("click", () => this.by(1));
    if (picture.frames > 1) return;
    window.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (by && !event.altKey && !event.ctrlKey && !event.metaKey) { this.by(by); event.preventDefault(); }
    });
  }

  get contact() {
    return this.chosen < 0 ? null : picture.contacts[this.chosen];
  }

  by(steps) {
    const all = this.rows.length;
    this.choose(this.chosen < 0 ? (steps > 0 ? 0 : all - 1) : (this.chosen + steps + all) % all);
  }

  choose(number) {
    if (!this.table) { this.changed(); return; }
    if (this.chosen >= 0) this.rows[this.chosen].classList.remove("chosen");
    this.chosen = number;
    const which = document.getElementById("which");
    if (number < 0) { which.value = "none chosen"; this.changed(); return; }
    const row = this.rows[number], list = row.closest("div.rows"), [step, first, second] = this.contact;
    row.classList.add("chosen");
    const head = this.table.tHead.offsetHeight;
    if (row.offsetTop - head < list.scrollTop) list.scrollTop = row.offsetTop - head;
    else if (row.offsetTop + row.offsetHeight > list.scrollTop + list.clientHeight) {
      list.scrollTop = row.offsetTop + row.offsetHeight - list.clientHeight;
    }
    const name = (body) => (picture.numbers ? picture.numbers[body] : body);
    which.value = `${number + 1} of ${this.rows.length}: ${name(first)} and ${name(second)}`;
    // A contact of a step is one of the bodies as they lay before it.
    if (picture.frames > 1) { this.playback.run(false); this.playback.seek(step / picture.every); }
    this.camera.goTo([this.place(), 3 * Math.max(picture.radii[first], picture.radii[second])]);
    this.changed();
  }

  /** The value of a field of the chosen contact, if it was asked for. */
  field(name) {
    const place = picture.fields.indexOf(name);
    return place < 0 ? null : this.contact[3][place];
  }

  vector(names) {
    const values = names.map((name) => this.field(name));
    return values.includes(null) ? null : values;
  }

  /** Its point, or the place between both surfaces where no point was asked for. */
  place() {
    const [, first, second] = this.contact, time = this.playback.shown;
    const [a, b] = [centre(first, time), centre(second, time)];
    const share = picture.radii[first] / (picture.radii[first] + picture.radii[second]);
    return this.vector(["pos_x", "pos_y", "pos_z"]) || mix(a, b, share);
  }

  /** Small spheres over everything: the contact's point, and dots along its normal. */
  marks() {
    if (!this.contact) return null;
    const [, first, second] = this.contact, size = Math.min(picture.radii[first], picture.radii[second]);
    const point = this.vector(["pos_x", "pos_y", "pos_z"]), normal = this.vector(["normal_x", "normal_y", "normal_z"]), numbers = [];
    const dot = (place, radius) => numbers.push(...place, radius, 1, 0.15, 0.3, 1, 0, 0, 0, 1, 0);
    if (point || normal) dot(this.place(), size * 0.09);
    for (let i = 1; normal && i <= 12; i++) dot(add(this.place(), times(normal, size * 0.12 * i)), size * 0.035);
    return new Float32Array(numbers);
  }
}
