// What landmarks are called, and which point of the vehicle the fixes are of.
const landmarkName = (id) => (data.names && data.names[id]) || id;

const shortName = (id) => {
  const letters = [...String(landmarkName(id))];
  return letters.length > 24 ? `${letters.slice(0, 23).join("")}…` : letters.join("");
};

// In a text that the charts read as markup.
const hoverName = (id) => String(landmarkName(id)).replace(/&/g, "&amp;").replace(/</g, "&lt;");

const antennaPlace = () => {
  const [x, y] = data.antenna;
  const parts = [[x, x > 0 ? "ahead of" : "behind"], [y, y > 0 ? "to the left of" : "to the right of"]];
  const said = parts.filter(([value]) => value !== 0).map(([value, where]) => `${Number(Math.abs(value).toFixed(2))} m ${where}`);
  return `${said.join(" and ")} the path's point`;
};

const writeAntenna = () => {
  if (!data.antenna) return;
  byId("truth-of").textContent = `: positions of the antenna, ${antennaPlace()}`;
  byId("truth-point").textContent = " (antenna)";
};
