// Reads the page's one block of data and builds what is for its kind.

{
  const data = JSON.parse(document.getElementById("page-data").textContent);
  document.documentElement.classList.add("live");
  if (data.kind === "plan") new PlanPage(data);
  if (data.kind === "evaluation") new EvaluationPage(data);
  if (data.kind === "run") new RunPage(data);
  if (data.kind === "live") new LivePage(data);
}
