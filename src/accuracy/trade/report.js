(() => {
  const table = document.getElementById('points'), shown = document.getElementById('row');
  const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
  const show = name => {
    const row = [...body.rows].find(row => row.dataset.name === name);
    if (!row) return;
    document.querySelectorAll('.chosen').forEach(old => old.classList.remove('chosen'));
    row.classList.add('chosen');
    document.querySelectorAll('[data-point]').forEach(point => {
      if (point.dataset.point === name) point.classList.add('chosen');
    });
    shown.replaceChildren(...heads.map((head, i) => {
      const cell = document.createElement('span'), label = document.createElement('small');
      label.textContent = head.textContent;
      cell.append(label, ' ', row.cells[i].textContent);
      return cell;
    }));
  };
  const pointed = event => {
    const at = event.target.closest?.('[data-point], [data-name]');
    if (at) show(at.dataset.point ?? at.dataset.name);
  };
  document.addEventListener('pointerover', pointed);
  document.addEventListener('focusin', pointed);
  heads.forEach((head, i) => head.addEventListener('click', () => {
    const up = head.getAttribute('aria-sort') !== 'ascending';
    heads.forEach(other => other.removeAttribute('aria-sort'));
    head.setAttribute('aria-sort', up ? 'ascending' : 'descending');
    const value = row => row.cells[i].dataset.v ?? row.cells[i].textContent;
    const order = (a, b) => {
      const [x, y] = [value(a), value(b)];
      if (x === '' || y === '') return (x === '') - (y === '');  // what was not measured stands last
      const less = isNaN(x) || isNaN(y) ? x.localeCompare(y) : x - y;
      return up ? less : -less;
    };
    body.replaceChildren(...[...body.rows].sort(order));
  }));
})();
