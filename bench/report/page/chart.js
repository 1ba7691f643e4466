// A chart of the page: its menus set the signals of a Vega-Lite view, its colours follow the page's.
const dark = matchMedia("(prefers-color-scheme: dark)"), narrow = matchMedia("(max-width: 720px)");

function config() {
  const ink = dark.matches ? "#e6eaee" : "#1d2329", grid = dark.matches ? "#3a424a" : "#dfe3e7";
  const colours = {labelColor: ink, titleColor: ink};
  return {
    background: "transparent",
    axis: {...colours, gridColor: grid, domainColor: ink, tickColor: ink},
    legend: {...colours, symbolSize: 90, symbolStrokeWidth: 0, symbolOpacity: 1,
             ...(narrow.matches ? {orient: "bottom", columns: 1, offset: 38, labelFontSize: 10, labelLimit: 235} : {orient: "right", offset: 14, labelFontSize: 11, labelLimit: 600})},
    title: {color: ink, subtitleColor: ink}, header: colours,
    text: {color: ink}, rule: {color: ink}
  };
}

function chart_of(chart) {
  const frame = element("div", {className: chart.scrolls ? "chart wide" : "chart"});
  const menus = element("div", {className: "menus"}), selects = [];
  let view = null;
  const apply = async () => {
    chart.menus.forEach((menu, k) => view.signal(menu.signal, menu.choices[selects[k].selectedIndex][0]));
    await view.runAsync();
  };
  for (const menu of chart.menus) {
    const select = element("select", {onchange: apply}, ...menu.choices.map(([, text]) => new Option(text)));
    selects.push(select);
    if (menu.choices.length > 1) menus.append(element("label", {}, menu.label + " ", select));
  }
  async function draw() {
    frame.setAttribute("data-drawn", "false");
    if (view) view.finalize();
    ({view} = await vegaEmbed(frame, chart.spec, {
      config: config(), renderer: chart.scrolls ? "canvas" : "svg", logLevel: vega.Error, tooltip: {theme: dark.matches ? "dark" : "light"},
      actions: {export: true, source: false, compiled: false, editor: false}
    }));
    await apply();
    frame.setAttribute("data-drawn", "true");
  }
  dark.addEventListener("change", draw);
  narrow.addEventListener("change", draw);
  frame.setAttribute("role", "group");
  frame.setAttribute("aria-label", "chart: " + chart.name);
  return {parts: selects.length ? [menus, frame] : [frame], draw};
}
