// Of many things that would cover each other one is drawn in each cell of the map. Cells stand still while the view moves, so that nothing
// flickers, and are at least so many pixels wide.
const makeCells = () => ({ taken: new Uint8Array(0), size: 1, x: 0, y: 0, columns: 0, rows: 0 });

const setCells = (cells, camera, pixels) => {
  const [x0, x1, y0, y1] = viewOf(camera, pixels);
  const size = cells.size = 2 ** Math.ceil(Math.log2(pixels / camera.scale));
  cells.x = Math.floor(x0 / size);
  cells.y = Math.floor(y0 / size);
  cells.columns = Math.floor(x1 / size) - cells.x + 1;
  cells.rows = Math.floor(y1 / size) - cells.y + 1;
  const needed = cells.columns * cells.rows;
  if (cells.taken.length < needed) cells.taken = new Uint8Array(2 * needed);
  else cells.taken.fill(0, 0, needed);
};

// Whether nothing was drawn there yet; not outside the view.
const takeCell = (cells, x, y) => {
  const column = Math.floor(x / cells.size) - cells.x, row = Math.floor(y / cells.size) - cells.y;
  if (column < 0 || row < 0 || column >= cells.columns || row >= cells.rows) return false;
  const at = row * cells.columns + column;
  if (cells.taken[at] === 1) return false;
  cells.taken[at] = 1;
  return true;
};
