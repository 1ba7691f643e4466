// Choices on the page: one scene for the whole page, and the menus of each chart. The address keeps
// them behind #, so a link can point to a view:
// #at=convergence&scene=free_string&work-precision.cost_field=rate
const view = new Map(new URLSearchParams(location.hash.slice(1)));
const on_scene = []; // functions called with the name of a new scene

function choose(key, value) {
  if (value === null) view.delete(key);
  else view.set(key, value);
  history.replaceState(null, "", "#" + new URLSearchParams([...view]));
}

const scene_shown = () => document.getElementById("scene")?.value ?? report.scenes[0] ?? "";

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
