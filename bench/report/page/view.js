// What of the page is chosen: one scene for all of it, and each chart's menus. It stands in the address behind #, so that a view can be linked to:
// #at=convergence&scene=free_string&work-precision.cost_field=rate
const view = new Map(new URLSearchParams(location.hash.slice(1)));
const on_scene = [];  // what follows the scene: called with its name

function choose(key, value) {
  if (value === null) view.delete(key);
  else view.set(key, value);
  history.replaceState(null, "", "#" + new URLSearchParams([...view]));
}

function scene_menu(scenes) {
  const select = element("select", {id: "scene"}, ...scenes.map(name => new Option(name)));
  select.selectedIndex = Math.max(0, scenes.indexOf(view.get("scene")));
  select.onchange = async () => {
    choose("scene", select.selectedIndex === 0 ? null : select.value);
    document.documentElement.dataset.ready = "false";
    for (const follow of on_scene) await follow(select.value);
    document.documentElement.dataset.ready = "true";
  };
  return element("label", {}, "scene ", select);
}

function verdict_of(verdicts, command) {
  const table = element("table"), sentences = element("div", {className: "soft"});
  const show = scene => {
    const v = verdicts.find(one => one.scene === scene) ?? verdicts[0];
    const head = element("tr", {}, ...v.columns.map(name => Object.assign(element("th", {className: "text"}, name), {scope: "col"})));
    table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...v.rows.map(row =>
      element("tr", {}, ...row.map((text, k) => element("td", {className: "text"}, text)).map((td, k) => { td.dataset.name = v.columns[k]; return td; })))));
    table.hidden = v.rows.length === 0;
    sentences.replaceChildren(...v.sentences.map(text => element("p", {}, text)));
  };
  on_scene.push(show);
  show(document.getElementById("scene")?.value ?? verdicts[0].scene);
  const section = element("section", {id: "verdict"}, element("h2", {}, "Verdict"), element("div", {className: "cards"}, table), sentences);
  if (command) section.append(element("p", {className: "soft"}, "Made by ", element("code", {}, command)));
  return section;
}
